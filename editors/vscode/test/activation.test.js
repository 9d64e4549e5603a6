// The extension with a stand-in for VS Code: what it registers and starts, and what it says when that fails.

const assert = require("node:assert");
const { chmodSync, mkdtempSync, writeFileSync } = require("node:fs");
const Module = require("node:module");
const { tmpdir } = require("node:os");
const path = require("node:path");
const test = require("node:test");

/** Anything of the API: callable, constructible, and each member the same again. */
const anything = () => new Proxy(function () {}, { get: (_, name) => (name === "then" ? undefined : anything()), construct: () => ({}), apply: () => anything() });

/** Loads the extension; returns its exports and what it did. */
function load(command, startFails) {
  const did = { commands: {}, started: [], errors: [], registered: {}, items: new Map(), runs: [] };
  const record = (name) => (type, what) => (did.registered[`${name} ${type}`] = what);
  const settings = { command, "run.robot": "kinematic", "run.io": "auto" };
  const items = () => {
    const map = new Map();
    return { add: (one) => map.set(one.id, one), get: (id) => map.get(id), replace: (all) => (map.clear(), all.forEach((one) => map.set(one.id, one))), [Symbol.iterator]: () => map[Symbol.iterator]() };
  };
  const tests = { items: items(), createTestItem: (id, label, uri) => ({ id, label, uri, children: items() }), createRunProfile: (_, __, run) => (did.runTests = run) };
  did.tests = tests;
  tests.createTestRun = () => new Proxy({}, { get: (_, name) => (item) => did.runs.push([name, item?.label]) });
  const api = {
    workspace: {
      getConfiguration: () => ({ get: (name) => settings[name] }),
      workspaceFolders: [],
      getWorkspaceFolder: () => undefined,
      asRelativePath: (uri) => path.basename(uri.fsPath),
      findFiles: async () => [{ fsPath: path.join(__dirname, "test_a.toml"), toString: () => "file:test_a.toml" }],
    },
    window: { showErrorMessage: async (text) => void did.errors.push(text), activeTextEditor: { document: { languageId: "krl", uri: { fsPath: "/cell/a.src" } } } },
    commands: { registerCommand: (name, run) => (did.commands[name] = run) },
    debug: { registerDebugConfigurationProvider: record("configuration"), registerDebugAdapterDescriptorFactory: record("adapter") },
    DebugAdapterExecutable: class { constructor(...given) { this.given = given; } },
    TestMessage: class { constructor(message) { this.message = message; } },
    tests: { createTestController: () => tests },
  };
  const fill = (made) => new Proxy(made, { get: (has, name) => has[name] ?? anything() });
  for (const name of ["workspace", "window", "commands", "debug"]) api[name] = fill(api[name]);
  class LanguageClient {
    constructor(_id, _name, server, client) { this.asked = { server, client }; }
    async start() {
      did.started.push(this.asked);
      if (startFails) throw "Launching server using command failed."; // the library rejects with texts
    }
  }
  const stands = { vscode: fill(api), "vscode-languageclient/node": { LanguageClient } };
  const real = Module._load;
  Module._load = (name, ...more) => stands[name] ?? real(name, ...more);
  for (const file of ["extension", "run", "tests"]) delete require.cache[require.resolve(`../${file}`)];
  try {
    return [require("../extension"), did];
  } finally {
    Module._load = real;
  }
}

test("the language server, the debugger and all commands of the manifest are there", async () => {
  const [extension, did] = load("my krl");
  await extension.activate({ subscriptions: [] });
  assert.deepStrictEqual(did.started[0].server, { command: "my krl", args: ["lsp"] });
  assert.deepStrictEqual(did.started[0].client.documentSelector, [{ scheme: "file", language: "krl" }]);
  const { contributes } = require("../package.json");
  assert.deepStrictEqual(Object.keys(did.commands).sort(), contributes.commands.map((one) => one.command).sort());
  const adapter = did.registered["adapter krl"].createDebugAdapterDescriptor({});
  assert.deepStrictEqual(adapter.given.slice(0, 2), ["my krl", ["debug", "--dap"]]);
  const found = did.registered["configuration krl"].resolveDebugConfiguration(undefined, {});
  assert.deepStrictEqual([found.program, found.robot, found.io], ["/cell/a.src", "kinematic", "auto"]);
  const properties = contributes.debuggers[0].configurationAttributes.launch.properties;
  for (const name of ["program", "robot", "io"]) assert.ok(properties[name], name);
});

test("a server that does not start is one message that names the cure", async () => {
  const [extension, did] = load("krl", true);
  await extension.activate({ subscriptions: [] });
  assert.deepStrictEqual(did.errors, ["krl lsp did not start: pip install 'krl-workbench[lsp]', or set krl.command."]);
});

test("the test explorer lists the cases of each file, runs it and tells each case", { skip: process.platform === "win32" }, async () => {
  const command = path.join(mkdtempSync(path.join(tmpdir(), "krl-")), "krl");
  const junit = '<testsuites><testcase name="opens" time="0.5"/><testcase name="shuts" time="1"><failure>late</failure></testcase></testsuites>';
  const lines = ['[ "$1 $3" = "test --junit" ] && echo "$junit" > "$4" && exit 1', '[ "$4" = --collect-only ] && echo "test_a.toml::opens, slowly\n\n1 test collected"'];
  writeFileSync(command, ["#!/bin/sh", `junit='${junit}'`, ...lines, ""].join("\n"));
  chmodSync(command, 0o755);
  const [extension, did] = load(command);
  await extension.activate({ subscriptions: [] });
  await did.tests.resolveHandler();
  const file = did.tests.items.get("file:test_a.toml");
  await did.tests.resolveHandler(file);
  assert.deepStrictEqual([...file.children].map(([, one]) => one.label), ["opens, slowly"]);
  await did.runTests({}, { onCancellationRequested: () => {} });
  const told = did.runs.filter(([name]) => ["passed", "failed", "errored"].includes(name));
  assert.deepStrictEqual(told, [["passed", "opens"], ["failed", "shuts"], ["failed", "test_a.toml"]]);
});
