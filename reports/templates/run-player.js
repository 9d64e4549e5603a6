// Playing the run: button, slider and keys.

/** Returns a function that tells whether the run is playing. */
function player() {
  const [button, slider, rate] = ["play", "slider", "rate"].map(byId);
  let before = null; // the frame before in ms, while it plays

  function show() {
    button.textContent = before === null ? "▶" : "❚❚";
    button.setAttribute("aria-label", before === null ? "Play" : "Pause");
  }
  function pause() {
    before = null;
    show();
  }
  function tick(now) {
    if (before === null) return;
    pointAt(moment + 1000 * Math.max(0, now - before) * Number(rate.value), "player");
    before = now;
    if (moment >= end) pause();
    else requestAnimationFrame(tick);
  }
  function toggle() {
    if (before !== null) {
      pause();
      return;
    }
    if (moment >= end) pointAt(0, "player");
    before = performance.now();
    show();
    requestAnimationFrame(tick);
  }
  /** Returns the start of the previous or next motion, or else the end of the run. */
  function neighbour(step) {
    const place = step > 0 ? placeAt(startTimes, moment) + 1 : placeAt(startTimes, moment - 1);
    return startTimes[place] ?? (step > 0 ? end : 0);
  }

  slider.max = end;
  slider.step = Math.max(1, Math.round(end / 10_000));
  button.addEventListener("click", toggle);
  slider.addEventListener("input", () => pointAt(Number(slider.value), "player"));
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || event.defaultPrevented) return;
    if (event.target.closest("input[type=search], select") || (event.key === " " && event.target.closest("button, a"))) return;
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (event.key === " ") toggle();
    else if (step && event.shiftKey) pointAt(neighbour(step), "player");
    else if (step) pointAt(moment + step * 100_000, "player");
    else return;
    event.preventDefault();
  });
  followers.push((time, by) => {
    if (by !== "player") pause();
    slider.value = time;
    const line = motionStarts[placeAt(startTimes, time)]?.at;
    slider.setAttribute("aria-valuetext", `${seconds(time)} seconds${line ? `, ${line}` : ""}`);
    byId("moment").textContent = `${seconds(time)} s`;
  });
  show();
  return () => before !== null;
}
const isPlaying = player();
