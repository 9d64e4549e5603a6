// Starts `krl lsp` for KRL files, and no more: all that is known of KRL is known by the server.

const { workspace } = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

exports.activate = () => {
  const command = workspace.getConfiguration("krl").get("command");
  client = new LanguageClient(
    "krl",
    "KRL workbench",
    { command, args: ["lsp"] },
    {
      documentSelector: [{ scheme: "file", language: "krl" }],
      synchronize: { fileEvents: workspace.createFileSystemWatcher("**/*.{src,dat,sub}") },
    },
  );
  return client.start();
};

exports.deactivate = () => client?.stop();
