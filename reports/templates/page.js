// Common to all pages: the data, number formats, creation of elements. reports/ puts the scripts of
// a page into one strict block, so the scripts after this one can use its names.

const page = JSON.parse(document.getElementById("page-data").textContent);
const number = (value) => value.toLocaleString("en-GB");
const counted = (value, noun) => `${number(value)} ${noun}${value === 1 ? "" : "s"}`;
/** Returns a share in per cent, never rounded up to 100 %. */
function percent(part, whole) {
  const tenths = Math.floor((1000 * part) / whole);
  return tenths >= 1000 ? "100 %" : `${(tenths / 10).toFixed(1)} %`;
}
const signed = (value) => `${value < 0 ? "−" : "+"}${number(Math.abs(value))}`;

const byId = (id) => document.getElementById(id);

/** Creates an element with a class and children; texts become text nodes, null is left out. */
function el(tag, className, ...children) {
  const element = document.createElement(tag);
  if (className) element.className = className;
  element.append(...children.flat().filter((child) => child !== null));
  return element;
}

const SVG = "http://www.w3.org/2000/svg";
function svg(tag, attributes, text) {
  const node = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  if (text !== undefined) node.textContent = text;
  return node;
}

function button(label, action, title = "") {
  const element = el("button", "", label);
  element.type = "button";
  if (title) element.title = title;
  element.addEventListener("click", () => action(element));
  return element;
}

function copyButton(text, label = "Copy") {
  return button(label, (self) => {
    const done = () => {
      self.textContent = "Copied";
      setTimeout(() => { self.textContent = label; }, 1500);
    };
    const byHand = () => {
      const area = el("textarea", "unseen");
      area.value = text;
      document.body.append(area);
      area.select();
      if (document.execCommand("copy")) done();
      area.remove();
      self.focus();
    };
    if (navigator.clipboard) navigator.clipboard.writeText(text).then(done, byHand);
    else byHand();
  }, `Copies: ${text.length > 80 ? `${text.slice(0, 79)}…` : text}`);
}

/** Returns a part of a card with a title. */
function part(title, ...content) {
  return el("section", "", title ? el("h3", "", title) : null, ...content);
}

/** Returns a folded part whose content is created when it is unfolded. */
function folded(summary, build) {
  const details = el("details", "", el("summary", "", ...summary));
  details.addEventListener("toggle", () => {
    if (details.open && details.childElementCount === 1) {
      details.append(build());
      settle(details);
    }
  });
  return details;
}

/** Lets arrow keys move between the buttons that open a table's rows. */
function walkWithArrows(body) {
  body.addEventListener("keydown", (event) => {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (!step || !event.target.classList.contains("open")) return;
    event.preventDefault();
    let row = event.target.closest("tr");
    do row = step > 0 ? row.nextElementSibling : row.previousElementSibling;
    while (row && (row.hidden || !row.classList.contains("row")));
    if (row) row.querySelector(".open").focus();
  });
}

const MOST_ROWS = 100;

/**
 * Shows the first rows of a list that no filter hides, and a button for the others. The returned
 * function must be called whenever rows have changed; with `true` it shows all rows.
 */
function shortList(body) {
  const heads = [...body.parentElement.tHead.rows[0].cells].map((head) => head.textContent.trim());
  for (const row of body.rows) [...row.cells].forEach((cell, n) => { cell.dataset.label = heads[n]; });
  const more = el("button", "more");
  more.type = "button";
  body.parentElement.after(more);
  let isWhole = false;
  function shorten(whole = isWhole) {
    isWhole = whole;
    const fitting = body.querySelectorAll(":scope > .row:not([hidden])");
    fitting.forEach((row, n) => row.classList.toggle("later", !isWhole && n >= MOST_ROWS));
    more.hidden = isWhole || fitting.length <= MOST_ROWS;
    more.textContent = `${number(fitting.length - MOST_ROWS)} more`;
  }
  more.addEventListener("click", () => shorten(true));
  return shorten;
}

/** Calls `toggle` on a click on a row; one that selects text only counts on the row's button. */
function onRow(body, toggle) {
  body.addEventListener("click", (event) => {
    const row = event.target.closest(".row");
    const marking = !getSelection().isCollapsed && getSelection().containsNode(row ?? document.body, true);
    if (row && (!marking || event.target.closest(".open"))) toggle(Number(row.dataset.i));
  });
}

function setHash(text) {
  try { history.replaceState(null, "", text ? `#${text}` : location.pathname + location.search); } catch { /* some browsers refuse it for local files */ }
}

/** Draws now, and whenever the width of the holder changes. */
function whenResized(holder, draw) {
  let drawn = holder.clientWidth;
  draw();
  new ResizeObserver(() => {
    if (holder.clientWidth === drawn) return;
    drawn = holder.clientWidth;
    draw();
  }).observe(holder);
}

/** Calls `draw` whenever the colour scheme changes between light and dark. */
const whenRecoloured = (draw) => matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
/** Returns a colour of the style sheet. */
const colourOf = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
