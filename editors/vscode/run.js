// A run of the program in the editor, with its page beside it.

const { execFile } = require("child_process");
const { mkdtemp, readFile, rm } = require("fs/promises");
const { tmpdir } = require("os");
const path = require("path");
const vscode = require("vscode");

const pages = new Map();

/** Runs a program and shows its page; one page a program, renewed by each run. */
exports.runPage = async (uri, setting) => {
  const file = (uri ?? vscode.window.activeTextEditor?.document.uri)?.fsPath;
  if (!file) return;
  await vscode.workspace.saveAll(false);
  const name = path.basename(file);
  const folder = await mkdtemp(path.join(tmpdir(), "krl-run-"));
  const page = path.join(folder, "run.html");
  const given = ["run", file, "--robot", setting("run.robot"), "--io", setting("run.io"), "--html", page];
  try {
    const said = await vscode.window.withProgress(
      { location: vscode.ProgressLocation.Notification, title: `KRL: running ${name}`, cancellable: true },
      (_, token) => run(setting("command"), given, path.dirname(file), token),
    );
    const html = await readFile(page, "utf8").catch(() => undefined);
    if (html) show(file, name, html);
    const tell = said.status === 0 ? vscode.window.showInformationMessage : vscode.window.showWarningMessage;
    if (said.text) tell(`KRL: ${said.text}`);
  } finally {
    await rm(folder, { recursive: true, force: true });
  }
};

/** What the command says in its last line, and its status; 1 is a finding, and has a page. */
function run(command, given, cwd, token) {
  return new Promise((resolve) => {
    const child = execFile(command, given, { cwd, maxBuffer: 1 << 26 }, (error, out, err) => {
      if (token.isCancellationRequested) return resolve({ status: 0, text: "" });
      const missing = error?.code === "ENOENT" ? `${command} was not found: set krl.command` : "";
      const lines = (out.trim() || err.trim()).split("\n").filter((line) => !line.startsWith("page: "));
      resolve({ status: error ? 1 : 0, text: missing || lines.at(-1) });
    });
    token.onCancellationRequested(() => child.kill());
  });
}

function show(file, name, html) {
  let panel = pages.get(file);
  if (!panel) {
    const place = { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true };
    panel = vscode.window.createWebviewPanel("krl.run", `Run of ${name}`, place, { enableScripts: true, retainContextWhenHidden: true });
    panel.onDidDispose(() => pages.delete(file));
    pages.set(file, panel);
  }
  panel.webview.html = html; // one file that loads nothing, with its own policy
  panel.reveal(undefined, true);
}
