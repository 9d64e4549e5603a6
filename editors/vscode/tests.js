// Unit tests of robot programs in the test explorer: `krl test` runs them, its JUnit file tells.

const { execFile } = require("child_process");
const { mkdtemp, readFile, rm } = require("fs/promises");
const { tmpdir } = require("os");
const path = require("path");
const vscode = require("vscode");
const { readJunit } = require("./junit");

const FILES = "**/test_*.{toml,src}";

/** The controller of the explorer: an item a file, and below it a case each. */
exports.testExplorer = (setting) => {
  const tests = vscode.tests.createTestController("krl", "KRL");
  const add = (uri) => {
    const file = tests.createTestItem(uri.toString(), vscode.workspace.asRelativePath(uri), uri);
    file.canResolveChildren = true;
    tests.items.add(file);
  };
  tests.resolveHandler = async (file) => {
    if (!file) return (await vscode.workspace.findFiles(FILES)).forEach(add);
    const { text } = await krlTest(setting("command"), file, ["--", "--collect-only", "-q"]);
    const found = text.split(/\r?\n/).filter((line) => line.includes("::"));
    if (found.length) setCases(tests, file, found.map((line) => line.slice(line.indexOf("::") + 2)));
  };
  const watcher = vscode.workspace.createFileSystemWatcher(FILES);
  watcher.onDidCreate(add);
  watcher.onDidDelete((uri) => tests.items.delete(uri.toString()));
  tests.createRunProfile("Run", vscode.TestRunProfileKind.Run, async (request, token) => {
    if (!request.include) await tests.resolveHandler();
    const chosen = request.include ?? [...tests.items].map(([, item]) => item);
    const run = tests.createTestRun(request);
    for (const file of new Set(chosen.map((item) => item.parent ?? item))) {
      if (!token.isCancellationRequested) await runFile(tests, run, file, setting("command"), token);
    }
    run.end();
  });
  return vscode.Disposable.from(tests, watcher);
};

/** Runs `krl test` on a file; returns whether it failed, and what it says. */
function krlTest(command, file, given, token) {
  return new Promise((resolve) => {
    const cwd = vscode.workspace.getWorkspaceFolder(file.uri)?.uri.fsPath;
    const child = execFile(command, ["test", file.uri.fsPath, ...given], { cwd, maxBuffer: 1 << 26 }, (error, out, err) =>
      resolve({ failed: Boolean(error), text: out + err }),
    );
    token?.onCancellationRequested(() => child.kill());
  });
}

function setCases(tests, file, names) {
  file.children.replace(names.map((name) => tests.createTestItem(`${file.id}::${name}`, name, file.uri)));
}

async function runFile(tests, run, file, command, token) {
  run.started(file);
  const folder = await mkdtemp(path.join(tmpdir(), "krl-test-"));
  const junit = path.join(folder, "junit.xml");
  try {
    const said = await krlTest(command, file, ["--junit", junit], token);
    run.appendOutput(said.text.replace(/\r?\n/g, "\r\n"), undefined, file);
    const cases = readJunit(await readFile(junit, "utf8").catch(() => ""));
    if (cases.length) setCases(tests, file, cases.map((one) => one.name));
    for (const one of cases) {
      const item = file.children.get(`${file.id}::${one.name}`);
      if (one.skipped) run.skipped(item);
      else if (one.message === undefined) run.passed(item, one.milliseconds);
      else run.failed(item, new vscode.TestMessage(one.message), one.milliseconds);
    }
    if (!cases.length && said.failed) run.errored(file, new vscode.TestMessage(said.text || `${command} test failed`));
    else if (cases.some((one) => one.message !== undefined)) run.failed(file, []);
    else run.passed(file);
  } finally {
    await rm(folder, { recursive: true, force: true });
  }
}
