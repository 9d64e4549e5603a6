// The table of steps: open, search, and links to its rows (#c-0012, #q=TEXT).

const rows = [...document.querySelectorAll("#rows > .row")];
const cards = new Map();
const indexOf = new Map(steps.map((step, i) => [step.anchor, i]));
const shorten = rows.length ? shortList(byId("rows")) : null;
const isOpen = (i) => rows[i].classList.contains("opened");

function changes(i) {
  if (i === 0) return null;
  const before = steps[i - 1].metrics;
  const moved = Object.entries(steps[i].metrics).filter(([name, value]) => value !== before[name]);
  return part("Metrics", el("p", "changes", ...(moved.length ? moved.map(([name, value]) => {
    const delta = el("span", "", el("b", "", name), ` ${written(before[name] ?? 0)} → ${written(value)}`);
    delta.title = page.meanings[name] ?? "";
    return delta;
  }) : ["unchanged"])));
}

function files(title, total, listed) {
  if (!total) return null;
  return part("", folded([el("b", "", number(total)), ` ${title}`], () => el("ul", "paths one",
    ...listed.map((path) => el("li", "", path)),
    total > listed.length ? el("li", "more", `… ${number(total - listed.length)} more`) : null)));
}

function card(i) {
  const step = steps[i];
  const link = el("a", "at", step.id);
  link.href = `#${step.anchor}`;
  link.title = "Link to this step";
  const fewer = i === 0 ? 0 : steps[i - 1].failing - step.failing;
  const line = i === 0
    ? el("span", "", el("b", "", number(step.parsed)), ` of ${number(page.files)} files parse before the first construct`)
    : el("span", "", el("b", "", number(step.restored)), ` ${step.restored === 1 ? "file parses" : "files parse"} that did not before · `,
      el("b", "", number(step.parsed)), ` of ${number(page.files)} parse now · `,
      el("b", "", number(Math.abs(fewer))), ` ${fewer < 0 ? "more" : "fewer"} failing lines`);
  return el("div", "sheet", el("p", "facts", line, link), summaryOf(step),
    el("div", "halves",
      el("div", "", editOf(step), ...examplesOf(step)),
      el("div", "", evidenceOf(step), files(step.restored === 1 ? "file restored" : "files restored", step.restored, step.restoredFiles),
        files(step.broken === 1 ? "file no longer parses" : "files no longer parse", step.broken, step.brokenFiles), changes(i))));
}

function setOpen(i, open) {
  const opener = rows[i].querySelector(".open");
  if (open && !cards.has(i)) {
    const cell = el("td", "", card(i));
    cell.colSpan = rows[i].cells.length;
    const row = el("tr", "card", cell);
    row.id = `card-${i}`;
    opener.setAttribute("aria-controls", row.id);
    cards.set(i, row);
    rows[i].after(row);
    settle(row);
  }
  if (cards.has(i)) cards.get(i).hidden = !open || rows[i].hidden;
  rows[i].classList.toggle("opened", open);
  opener.setAttribute("aria-expanded", String(open));
}

function toggle(i) {
  setOpen(i, !isOpen(i));
  setHash(isOpen(i) ? steps[i].anchor : "");
}

function goTo(anchor) {
  const i = indexOf.get(anchor);
  if (i === undefined) {
    byId("status").textContent = "No such step here";
    return;
  }
  if (rows[i].hidden) search("");
  if (rows[i].classList.contains("later")) shorten(true);
  setOpen(i, true);
  setHash(anchor);
  rows[i].scrollIntoView({ block: "start" });
  rows[i].querySelector(".open").focus({ preventScroll: true });
}

const haystacks = [];
function haystack(i) {
  const step = steps[i];
  haystacks[i] ??= [step.id, step.title, step.summary, ...step.grounds, ...step.evidence.rules, step.evidence.manual,
    ...step.evidence.seen, ...step.edits, step.diff, ...step.accept, ...step.reject, ...step.restoredFiles].join("\n").toLowerCase();
  return haystacks[i];
}

function search(text) {
  if (byId("search").value !== text) byId("search").value = text;
  const words = text.toLowerCase().split(/\s+/).filter(Boolean);
  let shownRows = 0;
  rows.forEach((row, i) => {
    row.hidden = !words.every((word) => haystack(i).includes(word));
    if (cards.has(i)) cards.get(i).hidden = row.hidden || !isOpen(i);
    shownRows += !row.hidden;
  });
  shorten();
  byId("status").textContent = shownRows < rows.length ? `${number(shownRows)} of ${counted(rows.length, "step")}` : counted(rows.length, "step");
  byId("none").hidden = shownRows > 0;
}

function readHash() {
  const hash = decodeURIComponent(location.hash.slice(1));
  if (hash.startsWith("q=")) search(new URLSearchParams(location.hash.slice(1)).get("q"));
  else if (hash.startsWith("c-")) goTo(hash);
}

if (rows.length) {
  onRow(byId("rows"), toggle);
  walkWithArrows(byId("rows"));
  byId("search").addEventListener("input", () => {
    search(byId("search").value);
    setHash(byId("search").value ? String(new URLSearchParams({ q: byId("search").value })) : "");
  });
  byId("biggest").addEventListener("click", (event) => {
    const link = event.target.closest("a");
    if (!link) return;
    event.preventDefault();
    goTo(link.dataset.step);
  });
  document.addEventListener("keydown", (event) => {
    if (event.key === "/" && event.target.tagName !== "INPUT") {
      event.preventDefault();
      byId("search").focus();
    }
  });
  rateChart();
  metricCharts();
  search("");
  readHash();
  addEventListener("hashchange", readHash);
}
