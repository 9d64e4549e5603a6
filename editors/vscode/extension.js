// What VS Code needs to reach the command krl: the language server, the debug adapter, runs, tests.
// All that is known of KRL is known there.

const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");
const { runPage } = require("./run");
const { testExplorer } = require("./tests");

const setting = (name) => vscode.workspace.getConfiguration("krl").get(name);
let client;

/** Starts the language server; if it cannot, a message names the cure. */
async function start() {
  const command = setting("command");
  client = new LanguageClient(
    "krl",
    "KRL workbench",
    { command, args: ["lsp"] },
    {
      documentSelector: [{ scheme: "file", language: "krl" }],
      // all files: of a folder that is deleted or renamed only the folder is told, and names have any case
      synchronize: { fileEvents: vscode.workspace.createFileSystemWatcher("**/*") },
    },
  );
  try {
    await client.start();
  } catch {
    client = undefined;
    const chosen = await vscode.window.showErrorMessage(
      // the client itself shows why
      `${command} lsp did not start: pip install 'krl-workbench[lsp]', or set krl.command.`,
      "Settings",
    );
    if (chosen) vscode.commands.executeCommand("workbench.action.openSettings", "krl.command");
  }
}

async function restart() {
  await client?.stop();
  await start();
}

/** The task that checks a folder; the problem matcher brings its findings to the list. */
function checkTask(folder) {
  const run = new vscode.ProcessExecution(setting("command"), ["check", "."], { cwd: folder.uri.fsPath });
  return new vscode.Task({ type: "krl", task: "check" }, folder, "check", "krl", run, "$krl");
}

const folders = () => vscode.workspace.workspaceFolders ?? [];

/** A debug session without launch.json debugs the program in the editor. */
const configurations = {
  resolveDebugConfiguration(_folder, given) {
    if (given.type) return given;
    const file = vscode.window.activeTextEditor?.document;
    if (file?.languageId !== "krl") return undefined;
    return { type: "krl", request: "launch", name: "KRL", program: file.uri.fsPath, robot: setting("run.robot"), io: setting("run.io") };
  },
};

const adapter = {
  createDebugAdapterDescriptor: (session) =>
    new vscode.DebugAdapterExecutable(setting("command"), ["debug", "--dap"], { cwd: session.workspaceFolder?.uri.fsPath }),
};

const step = (name) => () => vscode.debug.activeDebugSession?.customRequest(name, { threadId: 1 });

exports.activate = (context) => {
  context.subscriptions.push(
    vscode.commands.registerCommand("krl.run", (uri) => runPage(uri, setting)),
    vscode.commands.registerCommand("krl.restart", restart),
    vscode.commands.registerCommand("krl.check", () => folders().forEach((one) => vscode.tasks.executeTask(checkTask(one)))),
    vscode.commands.registerCommand("krl.stepMotion", step("stepMotion")),
    vscode.commands.registerCommand("krl.stepMotionBack", step("stepMotionBack")),
    vscode.debug.registerDebugConfigurationProvider("krl", configurations),
    vscode.debug.registerDebugAdapterDescriptorFactory("krl", adapter),
    vscode.tasks.registerTaskProvider("krl", { provideTasks: () => folders().map(checkTask), resolveTask: (task) => task }),
    vscode.workspace.onDidChangeConfiguration((change) => change.affectsConfiguration("krl.command") && restart()),
    testExplorer(setting),
  );
  return start();
};

exports.deactivate = () => client?.stop();
