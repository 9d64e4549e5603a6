// The source with the lines of the moment, and the list of events.

const mainRun = events.filter((event) => event.kind === "motion_start" && event.at);
const advanceRun = events.filter((event) => event.at && event.task !== "submit" && event.kind !== "motion_start");
const timesOf = (list) => list.map((event) => event.t);
const [mainTimes, advanceTimes] = [timesOf(mainRun), timesOf(advanceRun)];

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
  choice.addEventListener("change", () => open(Number(choice.value)));
  open(0);
  let marked = [];
  followers.push((time, by) => {
    for (const [row, name] of marked) row.classList.remove(name);
    marked = [];
    const at = [[mainRun[placeAt(mainTimes, time)]?.at, "main"], [advanceRun[placeAt(advanceTimes, time)]?.at, "ahead"]];
    for (const [place, name] of at) {
      const row = rows.get(place);
      if (!row) continue;
      row.classList.add(name);
      marked.push([row, name]);
      const [top, bottom] = [row.offsetTop, row.offsetTop + row.offsetHeight];
      if (by !== null && name === "main" && (top < holder.scrollTop || bottom > holder.scrollTop + holder.clientHeight)) holder.scrollTop = top - holder.clientHeight / 2;
    }
  });
}

const shown = new Set(["t", "task", "kind", "at"]);
const told = (event) => Object.entries(event).filter(([name]) => !shown.has(name)).map(([name, value]) => `${name} ${value}`).join(", ");

function eventTable() {
  const body = byId("events").tBodies[0];
  const quiet = new Set(["line", "assign", "branch"]);
  const listed = events.filter((event) => !quiet.has(event.kind)).slice(0, 5000);
  const rows = listed.map((event) => {
    const bad = ["fault", "message", "crash"].includes(event.kind) ? "bad" : "";
    const row = el("tr", "", el("td", "num", seconds(event.t, 6)), el("td", bad, event.kind.replaceAll("_", " ") + (event.task === "submit" ? " (submit)" : "")),
      el("td", "", event.at ?? ""), el("td", "", told(event)));
    row.addEventListener("click", () => pointAt(event.t, "events"));
    return row;
  });
  body.append(...rows);
  const times = timesOf(listed);
  const search = byId("search");
  const filter = () => {
    const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
    let count = 0;
    rows.forEach((row) => {
      const text = row.textContent.toLowerCase();
      row.hidden = !words.every((word) => text.includes(word));
      count += !row.hidden;
    });
    byId("status").textContent = counted(count, "event");
  };
  search.addEventListener("input", filter);
  filter();
  let now = null;
  followers.push((time) => {
    now?.classList.remove("now");
    now = rows[placeAt(times, time)] ?? null;
    now?.classList.add("now");
  });
}

program();
eventTable();
followers.push((time) => { byId("moment").textContent = `${seconds(time, 3)} s`; });
pointAt(0);
