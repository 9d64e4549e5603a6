// The source with the lines that are current, and the list of events.

const mainRun = motionStarts.filter((event) => event.at);
const timesOf = (list) => list.map((event) => event.t);
const [mainTimes, advanceTimes] = [timesOf(mainRun), timesOf(advanceRun)];

/** Scrolls a holder, not the page, if a row of it is out of sight. */
function keepInSight(holder, row) {
  const [top, bottom] = [row.offsetTop, row.offsetTop + row.offsetHeight];
  if (top < holder.scrollTop || bottom > holder.scrollTop + holder.clientHeight) holder.scrollTop = top - holder.clientHeight / 2;
}

function program() {
  const [holder, choice] = [byId("program"), byId("files")];
  if (!page.files.length) {
    holder.append(el("p", "hint", "No source was recorded."));
    choice.hidden = true;
    return;
  }
  page.files.forEach((file, n) => choice.append(new Option(file.path, n)));
  choice.hidden = page.files.length === 1;
  const rows = new Map();
  const firstAt = new Map();
  for (const event of events) if (event.at && !firstAt.has(event.at)) firstAt.set(event.at, event.t);

  function open(n) {
    const file = page.files[n];
    choice.value = n;
    rows.clear();
    holder.replaceChildren(...file.lines.map((text, i) => {
      const row = el("div", "l", el("span", "no", String(i + 1)), el("span", "tx", text || " "));
      rows.set(`${file.path}:${i + 1}`, row);
      const time = firstAt.get(`${file.path}:${i + 1}`);
      if (time !== undefined) row.addEventListener("click", () => pointAt(time));
      return row;
    }));
  }
  const fileOf = (event) => page.files.findIndex((file) => event?.at.startsWith(`${file.path}:`));
  choice.addEventListener("change", () => open(Number(choice.value)));
  open(0);
  let marked = [];
  followers.push((time, by) => {
    for (const [row, name] of marked) row.classList.remove(name);
    marked = [];
    const entered = by === "player" ? fileOf(mainRun[placeAt(mainTimes, time)]) : -1;
    if (entered >= 0 && entered !== Number(choice.value)) open(entered);
    const at = [[mainRun[placeAt(mainTimes, time)]?.at, "main"], [advanceRun[placeAt(advanceTimes, time)]?.at, "ahead"]];
    for (const [place, name] of at) {
      const row = rows.get(place);
      if (!row) continue;
      row.classList.add(name);
      marked.push([row, name]);
      if (by !== null && name === "main") keepInSight(holder, row);
    }
  });
}

const shown = new Set(["t", "task", "kind", "at"]);
/** Fields whose values are shown without their names. */
const bare = new Set(["what", "name", "text", "motion_kind"]);
const told = (event) => Object.entries(event).filter(([name]) => !shown.has(name)).map(([name, value]) => (bare.has(name) ? value : `${name.replaceAll("_", " ")} ${value}`)).join(", ");

const MORE = 500; // rows at a time

function eventTable() {
  const holder = byId("events");
  const body = holder.querySelector("tbody");
  const [search, more] = [byId("search"), byId("more")];
  const quiet = new Set(["line", "assign", "branch"]);
  const listed = events.filter((event) => !quiet.has(event.kind));
  const kindOf = (event) => event.kind.replaceAll("_", " ") + (event.task === "submit" ? " (submit)" : "");
  const cells = (event) => [seconds(event.t, 6), kindOf(event), event.at ?? "", told(event)];
  const texts = listed.map((event) => cells(event).join(" ").toLowerCase());
  let [found, times, rows, now] = [[], [], [], null];

  function grow() {
    const added = found.slice(rows.length, rows.length + MORE).map((event) => {
      const bad = ["fault", "message", "crash", "collision", "torque"].includes(event.kind) ? "bad" : "";
      const row = el("tr", "", ...cells(event).map((text, n) => el("td", ["num", bad, "", ""][n], text)));
      row.addEventListener("click", () => pointAt(event.t, "events"));
      return row;
    });
    rows.push(...added);
    body.append(...added);
    more.hidden = rows.length === found.length;
    more.textContent = counted(found.length - rows.length, "more event");
    mark();
  }
  function filter() {
    const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
    found = listed.filter((_, n) => words.every((word) => texts[n].includes(word)));
    times = timesOf(found);
    byId("status").textContent = counted(found.length, "event");
    rows = [];
    body.replaceChildren();
    grow();
  }
  function mark(_, by = null) {
    now?.classList.remove("now");
    now = rows[placeAt(times, moment)] ?? null;
    now?.classList.add("now");
    if (now && !["events", null].includes(by)) keepInSight(holder, now);
  }
  search.addEventListener("input", filter);
  more.addEventListener("click", grow);
  filter();
  followers.push(mark);
}

program();
eventTable();
pointAt(0);
