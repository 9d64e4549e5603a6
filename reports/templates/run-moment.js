// The point in time that all parts of the page show, and the state of the run at it.

const { path, limits } = page;
/** Observations outside the trace as events: contacts, and torques beyond the limits of an axis. */
const observed = page.observations.map(({ t, end: until, kind, at, parts, value, limit }) => ({
  t, kind, at, what: kind === "collision" ? parts.join(" touches ") : `${parts[0]} needs ${value} Nm and bears ${limit}`, until: `${(until / 1e6).toFixed(3)} s`,
}));
const events = [...page.events, ...observed].sort((a, b) => a.t - b.t);
const end = Math.max(page.end, path.t.at(-1) ?? 0, events.at(-1)?.t ?? 0, 1);
const seconds = (time, digits = 3) => (time / 1e6).toFixed(digits);

const followers = [];
let moment = 0;
/** Makes all parts show `time`; `by` is the part that asked, which need not follow itself. */
function pointAt(time, by = null) {
  moment = Math.min(end, Math.max(0, Math.round(time)));
  for (const follow of followers) follow(moment, by);
}

/** Returns the index of the last of some rising times that is not after `time`; -1 if none is. */
function placeAt(times, time) {
  let [low, high] = [0, times.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

/** Returns a function that interpolates columns of the path linearly at a time. */
function valuesAt(time) {
  const last = path.t.length - 1;
  const place = Math.min(Math.max(0, placeAt(path.t, time)), last);
  const next = Math.min(place + 1, last);
  const share = next > place ? (time - path.t[place]) / (path.t[next] - path.t[place]) : 0;
  return (values) => values[place] + (values[next] - values[place]) * share;
}

/** Returns a function that calls `act` at the next frame, only once even if called repeatedly. */
function atNextFrame(act) {
  let isWaiting = false;
  return () => {
    if (isWaiting) return;
    isWaiting = true;
    requestAnimationFrame(() => { isWaiting = false; act(); });
  };
}

/** Returns the names of the parts that touch something at a time. */
const touching = (time) => new Set(page.observations.flatMap(({ t, end: until, kind, parts }) => (kind === "collision" && t <= time && time <= until ? parts : [])));

const motionStarts = events.filter((event) => event.kind === "motion_start");
const startTimes = motionStarts.map((event) => event.t);
const AHEAD = new Set(["line", "assign", "branch", "motion_planned", "advance_stop", "call", "return", "wait", "halt", "end"]);
const advanceRun = events.filter((event) => AHEAD.has(event.kind) && event.at && event.task !== "submit");

/** Returns the spans in which two motions blend. */
const blends = [];
for (const event of events) {
  if (event.kind === "blend_start") blends.push([event.t, end]);
  else if (event.kind === "blend_end" && blends.length) blends.at(-1)[1] = event.t;
}
const blendStarts = blends.map(([from]) => from);
const isBlending = (time) => time <= (blends[placeAt(blendStarts, time)]?.[1] ?? -1);
