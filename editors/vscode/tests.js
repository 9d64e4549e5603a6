// Unit tests of robot programs in the test explorer: `krl test` runs them, its JUnit file tells.

const { execFile } = require("child_process");
const { mkdtemp, readFile, rm } = require("fs/promises");
const { tmpdir } = require("os");
const path = require("path");
const vscode = require("vscode");
const { readJunit } = require("./junit");

const FILES = "**/test_*.{toml,src}";

/** The controller of the explorer: an item a file, and below it a case each, once it has run. */
exports.testExplorer = (setting) => {
  const tests = vscode.tests.createTestController("krl", "KRL");
  const add = (uri) => tests.items.add(tests.createTestItem(uri.toString(), vscode.workspace.asRelativePath(uri), uri));
  tests.resolveHandler = async () => (await vscode.workspace.findFiles(FILES)).forEach(add);
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

async function runFile(tests, run, file, command, token) {
  run.started(file);
  const folder = await mkdtemp(path.join(tmpdir(), "krl-test-"));
  const junit = path.join(folder, "junit.xml");
  try {
    const said = await new Promise((resolve) => {
      const cwd = vscode.workspace.getWorkspaceFolder(file.uri)?.uri.fsPath;
      const child = execFile(command, ["test", file.uri.fsPath, "--junit", junit], { cwd, maxBuffer: 1 << 26 }, (error, out, err) =>
        resolve({ failed: Boolean(error), text: out + err }),
      );
      token.onCancellationRequested(() => child.kill());
    });
    run.appendOutput(said.text.replace(/\r?\n/g, "\r\n"), undefined, file);
    const cases = readJunit(await readFile(junit, "utf8").catch(() => ""));
    file.children.replace(cases.map((one) => tests.createTestItem(`${file.id}::${one.name}`, one.name, file.uri)));
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
