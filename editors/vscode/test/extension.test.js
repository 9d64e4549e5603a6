// The colours as VS Code's own tokenizer gives them, and the reader of JUnit files.

const assert = require("node:assert");
const { readFileSync } = require("node:fs");
const path = require("node:path");
const test = require("node:test");
const oniguruma = require("vscode-oniguruma");
const { Registry, parseRawGrammar } = require("vscode-textmate");
const { readJunit } = require("../junit");

const FILE = path.join(__dirname, "..", "syntaxes", "krl.tmLanguage.json");

async function scopes(line) {
  await oniguruma.loadWASM(readFileSync(require.resolve("vscode-oniguruma/release/onig.wasm")).buffer).catch(() => {});
  const registry = new Registry({
    onigLib: { createOnigScanner: (all) => new oniguruma.OnigScanner(all), createOnigString: (one) => new oniguruma.OnigString(one) },
    loadGrammar: async () => parseRawGrammar(readFileSync(FILE, "utf8"), FILE),
  });
  const grammar = await registry.loadGrammar("source.krl");
  return grammar.tokenizeLine(line, null).tokens
    .filter((one) => line.slice(one.startIndex, one.endIndex).trim())
    .map((one) => [line.slice(one.startIndex, one.endIndex), one.scopes.at(-1).replace(/\.krl$/, "")]);
}

for (const [line, expected] of [
  ["DEFFCT REAL Area(n:IN)", { DEFFCT: "keyword.control", REAL: "storage.type", Area: "entity.name.function", IN: "keyword.other" }],
  ["global def cell( )", { global: "keyword.control", def: "keyword.control", cell: "entity.name.function" }],
  ["PTP XP1 C_PTP ; to the part", { PTP: "keyword.other.motion", C_PTP: "keyword.other.motion", "; to the part": "comment.line.semicolon" }],
  [';FOLD "x" ; y', { ';FOLD "x" ; y': "comment.line.fold" }],
  ['cText[]="; no comment"', { '"; no comment"': "string.quoted.double", cText: "variable.other" }],
  ["$OUT[7]=TRUE AND NOT bOk", { $OUT: "variable.language", 7: "constant.numeric", TRUE: "constant.language", AND: "keyword.operator.word", NOT: "keyword.operator.word" }],
  ["Part=Step[2]+1.5E-3", { Part: "variable.other", Step: "variable.other", "1.5E-3": "constant.numeric" }],
  ["WAIT SEC 0.5", { WAIT: "keyword.control", SEC: "keyword.other" }],
  ["e=#T1 B_AND 'H1F'", { "#T1": "variable.other.enummember", B_AND: "keyword.operator.word", "'H1F'": "constant.numeric.bits" }],
  ["x=ABS(y)+DEFINE(z)", { ABS: "support.function", DEFINE: "entity.name.function.call" }],
  ["&ACCESS RVP", { "&ACCESS RVP": "meta.preprocessor" }],
]) {
  test(`colours of ${line}`, async () => {
    const found = Object.fromEntries(await scopes(line));
    for (const [text, scope] of Object.entries(expected)) assert.strictEqual(found[text], scope, text);
  });
}

test("cases of a JUnit file", () => {
  const xml = `<?xml version="1.0"?><testsuites><testsuite name="krl"><testcase classname="a" name="opens &lt;1&gt; &quot;x&quot;" time="0.5" />
    <testcase name="b" time="0.1"><failure message="short">line 3:
a &gt; b</failure></testcase><testcase name="c" time="0"><skipped message="no"/></testcase></testsuite></testsuites>`;
  assert.deepStrictEqual(readJunit(xml), [
    { name: 'opens <1> "x"', milliseconds: 500, skipped: false, message: undefined },
    { name: "b", milliseconds: 100, skipped: false, message: "line 3:\na > b" },
    { name: "c", milliseconds: 0, skipped: true, message: undefined },
  ]);
  assert.deepStrictEqual(readJunit(""), []);
});
