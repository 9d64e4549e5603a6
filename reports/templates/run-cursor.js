// The moment that all parts of the page show, and the span of time that the charts show.

const byId = (id) => document.getElementById(id);
const { events, path } = page;
const end = Math.max(page.end, path.t.at(-1) ?? 0, events.at(-1)?.t ?? 0, 1);
const seconds = (time, digits = 3) => (time / 1e6).toFixed(digits);

const followers = [];
let moment = 0;
/** All parts show the moment `time`; `by` says who asked, so that it need not follow itself. */
function pointAt(time, by = null) {
  moment = Math.min(end, Math.max(0, Math.round(time)));
  for (const follow of followers) follow(moment, by);
}

/** The last place in a rising list of times that is not after `time`; -1 before the first. */
function placeAt(times, time) {
  let [low, high] = [0, times.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

/** Draws now and whenever the width of the holder changes. */
function whenResized(holder, draw) {
  let drawn = holder.clientWidth;
  draw();
  new ResizeObserver(() => {
    if (holder.clientWidth === drawn) return;
    drawn = holder.clientWidth;
    draw();
  }).observe(holder);
}

/** The spans in which two motions blend. */
const blends = [];
for (const event of events) {
  if (event.kind === "blend_start") blends.push([event.t, end]);
  else if (event.kind === "blend_end" && blends.length) blends.at(-1)[1] = event.t;
}
