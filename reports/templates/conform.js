// The list of cases: open, search, filter, also from the matrix and by links.

function settle() { /* sheets settle by themselves: their pictures are drawn when they are open */ }

const { cases } = page;
const EMPTY = { executor: "", robot: "", verdict: "", reason: "", ending: "", checks: [], events: [], findings: [], path: {} };
for (const one of cases) one.results = one.results.map((result) => ({ ...EMPTY, ...result }));
const body = byId("rows");
const state = { q: "", suite: "", verdict: "", case: "" };
const rows = cases.map((one, i) => {
  const opener = el("button", "open", one.name);
  opener.type = "button";
  opener.setAttribute("aria-expanded", "false");
  const row = el("tr", "row", el("td", "", verdictMark(one.verdict)), el("td", "", opener), el("td", "", one.title), el("td", "rule", one.rules.join(" ")));
  row.dataset.i = i;
  return row;
});
const sheets = new Map();
const texts = cases.map((one) => [one.name, one.title, ...one.rules, one.verdict, ...one.files.flatMap((file) => file.lines)].join("\n").toLowerCase());

function setOpen(i, open) {
  const row = rows[i];
  if (open && !sheets.has(i)) {
    const [sheet, draws] = caseSheet(cases[i]);
    const cell = el("td", "", sheet);
    cell.colSpan = 4;
    const line = el("tr", "card", cell);
    sheets.set(i, line);
    row.after(line);
    for (const draw of draws) draw();
  }
  if (sheets.has(i)) sheets.get(i).hidden = !open || row.hidden;
  row.classList.toggle("opened", open);
  row.querySelector(".open").setAttribute("aria-expanded", String(open));
}
const isOpen = (i) => rows[i].classList.contains("opened");

function toggle(i) {
  setOpen(i, !isOpen(i));
  state.case = isOpen(i) ? cases[i].name : state.case === cases[i].name ? "" : state.case;
  writeHash();
}

function filter() {
  const words = state.q.toLowerCase().split(/\s+/).filter(Boolean);
  let count = 0;
  cases.forEach((one, i) => {
    const fits = (!state.suite || one.suite === state.suite) && (!state.verdict || one.verdict === state.verdict || one.results.some((result) => result.verdict === state.verdict)) && words.every((word) => texts[i].includes(word));
    rows[i].hidden = !fits;
    if (sheets.has(i)) sheets.get(i).hidden = !fits || !isOpen(i);
    count += fits;
  });
  shorten();
  byId("status").textContent = counted(count, "case");
  byId("search").value = state.q;
  byId("suite").value = state.suite;
  byId("verdict").value = state.verdict;
}

function writeHash() {
  setHash(Object.entries(state).filter(([, value]) => value).map(([name, value]) => `${name}=${encodeURIComponent(value)}`).join("&"));
}

function readHash() {
  const given = new URLSearchParams(location.hash.slice(1));
  for (const name of Object.keys(state)) state[name] = given.get(name) ?? "";
  filter();
  const i = cases.findIndex((one) => one.name === state.case);
  if (i < 0) {
    if (state.case) byId("status").textContent = "No such case in this run";
    return;
  }
  if (rows[i].hidden) {
    Object.assign(state, { q: "", suite: "", verdict: "" });
    filter();
  }
  if (rows[i].classList.contains("later")) shorten(true);
  setOpen(i, true);
  rows[i].scrollIntoView({ block: "start" });
}

function choose(changes) {
  Object.assign(state, changes);
  filter();
  writeHash();
}

// The most severe ones come first.
const grave = ["fail", "known-failure", "unconfirmed", "skipped", "pass"];
body.append(...cases.map((_, i) => i).sort((a, b) => grave.indexOf(cases[a].verdict) - grave.indexOf(cases[b].verdict) || a - b).map((i) => rows[i]));
const shorten = shortList(body);
for (const suite of [...new Set(cases.map((one) => one.suite))]) byId("suite").append(new Option(suite, suite));
for (const verdict of page.verdicts) byId("verdict").append(new Option(verdict, verdict));
onRow(body, toggle);
walkWithArrows(body);
byId("search").addEventListener("input", (event) => choose({ q: event.target.value }));
byId("suite").addEventListener("change", (event) => choose({ suite: event.target.value }));
byId("verdict").addEventListener("change", (event) => choose({ verdict: event.target.value }));
byId("matrix").addEventListener("click", (event) => {
  const cell = event.target.closest("[data-suite]");
  if (!cell) return;
  event.preventDefault();
  choose({ q: "", suite: cell.dataset.suite, verdict: cell.dataset.verdict === "fail" ? "fail" : "" });
  byId("cases").scrollIntoView({ block: "start" });
});
addEventListener("hashchange", readHash);
trend();
readHash();
