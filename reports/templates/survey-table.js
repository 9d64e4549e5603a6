// The table of clusters: open, sort, search, filter, and links to its rows.

const rows = [...(byId("rows")?.querySelectorAll(":scope > .row") ?? [])];
const indexOf = new Map(clusters.map((cluster, i) => [cluster.id, i]));
const places = new Map(data.mending.map(([id, , place]) => [id, place]));
const cards = new Map();
const state = { cluster: "", q: "", sort: "" };
states[prefix] = state;
const shorten = byId("rows") ? shortList(byId("rows")) : () => {};

function setOpen(i, open) {
  const row = rows[i];
  const opener = row.querySelector(".open");
  if (open && !cards.has(i)) {
    const cell = el("td", "", card(clusters[i]));
    cell.colSpan = row.cells.length;
    const cardRow = el("tr", "card", cell);
    cardRow.id = `${prefix}card-${i}`;
    opener.setAttribute("aria-controls", cardRow.id);
    cards.set(i, cardRow);
    row.after(cardRow);
    settle(cardRow);
  }
  if (cards.has(i)) cards.get(i).hidden = !open || row.hidden;
  row.classList.toggle("opened", open);
  opener.setAttribute("aria-expanded", String(open));
}
const isOpen = (i) => rows[i].classList.contains("opened");

function toggle(i) {
  setOpen(i, !isOpen(i));
  if (isOpen(i)) state.cluster = clusters[i].id;
  else if (state.cluster === clusters[i].id) state.cluster = "";
  writeHash();
}

function goTo(id) {
  const i = indexOf.get(id);
  if (i === undefined) {
    byId("status").textContent = "No such cluster in this survey";
    return;
  }
  if (rows[i].hidden) clearFilters();
  if (rows[i].classList.contains("later")) shorten(true);
  setOpen(i, true);
  state.cluster = id;
  writeHash();
  rows[i].scrollIntoView({ block: "start" });
  rows[i].querySelector(".open").focus({ preventScroll: true });
}

const sortValue = {
  place: (i) => places.get(clusters[i].id) ?? Infinity,
  title: (i) => clusters[i].title.toLowerCase(),
  rule: (i) => clusters[i].rule.toLowerCase(),
  answer: (i) => answerOf(clusters[i])?.anchor ?? "~",
  unlocks: (i) => clusters[i].unlocks,
  files: (i) => clusters[i].files,
  origins: (i) => clusters[i].origins,
  failures: (i) => clusters[i].failures,
};
const ascendingFirst = new Set(["place", "title", "rule", "answer"]);

let shownOrder = rows.map((_, i) => i);
/** Sorts the rows by `sort`: a key, with "-" before it for descending, or "" for the survey's order. */
function order(sort) {
  const down = sort.startsWith("-");
  const key = sort.replace(/^-/, "");
  const value = Object.hasOwn(sortValue, key) ? sortValue[key] : null;
  const indices = rows.map((_, i) => i);
  if (value) {
    // Equal rows keep the survey's order, in both directions.
    const compare = (a, b) => (value(a) < value(b) ? -1 : value(a) > value(b) ? 1 : 0);
    indices.sort((a, b) => (down ? compare(b, a) : compare(a, b)) || a - b);
  }
  state.sort = value ? sort : "";
  const unmoved = indices.every((i, n) => i === shownOrder[n]);
  shownOrder = indices;
  if (!unmoved) byId("rows").append(...indices.flatMap((i) => (cards.has(i) ? [rows[i], cards.get(i)] : [rows[i]])));
  shorten();
  for (const head of byId("table").tHead.rows[0].cells) {
    if (value && head.dataset.key === key) head.setAttribute("aria-sort", down ? "descending" : "ascending");
    else head.removeAttribute("aria-sort");
  }
}

function nextSort(key) {
  const first = ascendingFirst.has(key) ? key : `-${key}`;
  const second = ascendingFirst.has(key) ? `-${key}` : key;
  return state.sort === first ? second : state.sort === second ? "" : first;
}

const haystacks = [];
function haystack(i) {
  if (haystacks[i] === undefined) {
    const cluster = clusters[i];
    haystacks[i] = [
      cluster.id, cluster.title, cluster.rule, cluster.token,
      ...[...cluster.stack, ...cluster.expected, ...cluster.originNames].map((n) => strings[n]),
      ...cluster.examples.flatMap((item) => [strings[item.path], ...item.lines.map(([, text]) => text)]),
      ...cluster.byOrigin.flatMap(([, , files]) => files.map(([path]) => strings[path])),
      cluster.reproducer ? cluster.reproducer.text : "",
      answerOf(cluster) ? `${answerOf(cluster).id}\n${answerOf(cluster).title}` : "",
    ].join("\n").toLowerCase();
  }
  return haystacks[i];
}

function filter() {
  const words = state.q.toLowerCase().split(/\s+/).filter(Boolean);
  const origin = byId("origin").value;
  let visibleRows = 0;
  rows.forEach((row, i) => {
    const cluster = clusters[i];
    const keep = (!origin || cluster.originNames.some((n) => strings[n] === origin))
      && (!byId("unlocking").checked || cluster.unlocks > 0)
      && (!byId("direct").checked || cluster.failures === 0 || cluster.follows < cluster.failures)
      && words.every((word) => haystack(i).includes(word));
    row.hidden = !keep;
    if (cards.has(i)) cards.get(i).hidden = !keep || !isOpen(i);
    visibleRows += keep;
  });
  shorten();
  const filtered = visibleRows < rows.length;
  byId("status").textContent = filtered ? `${number(visibleRows)} of ${counted(rows.length, "cluster")}` : counted(rows.length, "cluster");
  byId("clear").hidden = !(state.q || origin || byId("unlocking").checked || byId("direct").checked);
  byId("none").hidden = visibleRows > 0;
}

function search(text) {
  state.q = text;
  if (byId("search").value !== text) byId("search").value = text;
  filter();
}

function clearFilters() {
  byId("origin").value = "";
  byId("unlocking").checked = byId("direct").checked = false;
  search("");
}

// Links: #cluster=ID, #q=TEXT, #sort=-files; with the section's prefix before each

function readHash(given) {
  order(given.get(`${prefix}sort`) ?? "");
  search(given.get(`${prefix}q`) ?? "");
  if (given.has(`${prefix}cluster`)) goTo(given.get(`${prefix}cluster`));
}

function connect() {
  const names = [...new Set(clusters.flatMap((cluster) => cluster.originNames.map((n) => strings[n])))].sort();
  byId("origin").hidden = names.length < 2;
  byId("origin").append(...names.map((name) => {
    const option = el("option", "", name);
    option.value = name;
    return option;
  }));
  byId("unlocking").parentElement.hidden = !clusters.some((cluster) => cluster.unlocks > 0);
  byId("direct").parentElement.hidden = !clusters.some((cluster) => cluster.follows > 0);

  onRow(byId("rows"), toggle);
  walkWithArrows(byId("rows"));
  for (const head of byId("table").tHead.rows[0].cells) {
    head.querySelector("button").addEventListener("click", () => {
      order(nextSort(head.dataset.key));
      writeHash();
    });
  }
  byId("search").addEventListener("input", () => {
    search(byId("search").value);
    writeHash();
  });
  for (const id of ["origin", "unlocking", "direct"]) byId(id).addEventListener("change", filter);
  byId("clear").addEventListener("click", () => {
    clearFilters();
    writeHash();
    byId("search").focus();
  });
}
