// Source text with line numbers and carets; all characters are visible. Untrusted text reaches the
// page through text nodes only.

// Control, zero-width and bidirectional characters are shown as one sign each, so columns stay valid.
const UNSEEN = /[\0-\x08\x0a-\x1f\x7f-\x9f\xad\u061c\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff\ud800-\udfff]/u;
const SPLIT = new RegExp(`(${UNSEEN.source})`, "u");
function shown(character) {
  const code = character.codePointAt(0);
  const picture = code < 0x20 ? 0x2400 + code : code === 0x7f ? 0x2421 : 0xfffd;
  const sign = el("span", "control", String.fromCodePoint(picture));
  sign.title = `U+${code.toString(16).toUpperCase().padStart(4, "0")}`;
  return sign;
}
const visible = (text) =>
  text.split(SPLIT).filter(Boolean).map((part) => (UNSEEN.test(part) ? shown(part) : part));

function commentStart(characters) {
  let quoted = false;
  for (let i = 0; i < characters.length; i++) {
    if (characters[i] === '"') quoted = !quoted;
    else if (characters[i] === ";" && !quoted) return i;
  }
  return characters.length;
}

/** Returns a line of source as nodes; `from`, `to` bound the offending token, in characters from 0. */
function marked(characters, from, to) {
  const comment = commentStart(characters);
  const ends = [...new Set([from, to, comment, characters.length])]
    .filter((end) => end > 0 && end <= characters.length).sort((a, b) => a - b);
  let start = 0;
  return ends.map((end) => {
    const classes = [];
    if (start >= from && end <= to) classes.push("token");
    if (start >= comment) classes.push("comment");
    const piece = el("span", classes.join(" "), ...visible(characters.slice(start, end).join("")));
    start = end;
    return piece;
  });
}

/** Returns carets below the token, after white space for the text before it; tabs stay tabs. */
function carets(characters, from, to) {
  let before = "";
  for (let i = 0; i < from; i++) before += characters[i] === "\t" ? "\t" : " ";
  return el("div", "l caret", el("span", "no"),
    el("span", "tx", before, el("span", "marks", "^".repeat(Math.max(1, to - from)))));
}

/** Returns numbered lines; `at` (or null) is {line, column, width} of the token, columns from 1. */
function sourceBlock(lines, at) {
  const block = el("div", "source");
  block.tabIndex = 0;
  const digits = String(lines.length ? lines[lines.length - 1][0] : 0).length;
  block.style.setProperty("--gutter", `${Math.max(4, digits + 2.5)}ch`);
  for (const [no, text] of lines) {
    const characters = Array.from(text);
    const failing = at !== null && no === at.line;
    const points = failing && at.column > 0;
    const from = points ? at.column - 1 : -1;
    const to = points ? from + at.width : -1;
    block.append(el("div", failing ? "l failing" : "l", el("span", "no", String(no)),
      el("span", "tx", ...marked(characters, from, to))));
    if (points) block.append(carets(characters, from, to));
  }
  return block;
}

/**
 * Call this once `root` is in the page. It corrects the position of carets that wide characters or
 * slightly different widths of blanks have shifted, and scrolls to the token of a long line.
 */
function settle(root) {
  for (const marks of root.querySelectorAll(".marks")) {
    const block = marks.closest(".source");
    const token = marks.closest(".l").previousElementSibling.querySelector(".token");
    if (token) marks.style.left = `${token.getBoundingClientRect().left - marks.getBoundingClientRect().left}px`;
    const over = marks.getBoundingClientRect().right - block.getBoundingClientRect().right + 40;
    if (over > 0) block.scrollLeft += Math.max(over, block.clientWidth / 3);
  }
}

function diffBlock(text) {
  const block = el("div", "source bare");
  for (const line of text.replace(/\n$/, "").split("\n")) {
    const kind = line.startsWith("+") ? " add" : line.startsWith("-") ? " del" : line.startsWith("@@") ? " hunk" : "";
    block.append(el("div", `l${kind}`, el("span", "tx", ...visible(line))));
  }
  return block;
}
