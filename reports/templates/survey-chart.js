// The chart of the mending order: files that parse after mending the first n clusters.

const FIRST_STEPS = 40;

function chart() {
  const holder = byId("chart");
  const links = [...byId("steps").querySelectorAll("a")];
  const total = data.mending.length;
  let whole = true;
  const tip = el("div", "tip");
  tip.hidden = true;

  function draw() {
    const width = holder.clientWidth || 640;
    const height = 250;
    const [left, right, top, bottom] = [44, 14, 12, 36];
    const values = [data.parsed, ...data.mending.map(([, parsed]) => parsed)]
      .slice(0, (whole ? total : FIRST_STEPS) + 1).map((parsed) => (100 * parsed) / data.files);
    const last = values.length - 1;
    const low = values[0] < 40 ? 0 : Math.floor(Math.min(...values) / 10) * 10 - (values[0] % 10 < 2 ? 10 : 0);
    const x = (n) => left + ((width - left - right) * n) / last;
    const y = (value) => top + ((height - top - bottom) * (100 - value)) / (100 - low);
    const root = svg("svg", { width, height, viewBox: `0 0 ${width} ${height}`, role: "img" });
    root.append(svg("title", {}, `Files that parse: ${percent(data.parsed, data.files)} today, ${percent(data.mending[total - 1][1], data.files)} after ${counted(total, "cluster")}; the list beside the chart holds the same figures`));

    const every = 100 - low > 50 ? 20 : 10;
    for (let value = 100; value >= low; value -= every) {
      root.append(svg("line", { class: "grid", x1: left, x2: width - right, y1: y(value), y2: y(value) }),
        svg("text", { x: left - 8, y: y(value) + 4, "text-anchor": "end" }, `${value} %`));
    }
    const stride = [1, 2, 5, 10, 20, 50, 100, 200, 500].find((n) => last / n <= 10) ?? 1000;
    for (let n = 0; n <= last; n += stride) {
      root.append(svg("text", { x: x(n), y: height - bottom + 17, "text-anchor": "middle" }, number(n)));
    }
    root.append(svg("line", { class: "axis", x1: left, x2: width - right, y1: y(low), y2: y(low) }),
      svg("text", { x: (left + width - right) / 2, y: height - 2, "text-anchor": "middle" }, "clusters mended"));
    const path = values.map((value, n) => (n ? `H${x(n)}V${y(value)}` : `M${x(0)},${y(value)}`)).join("");
    root.append(svg("path", { class: "area", d: `${path}V${y(low)}H${x(0)}Z` }), svg("path", { class: "curve", d: path }));
    if (low < 95) {
      root.append(svg("line", { class: "target", x1: left, x2: width - right, y1: y(95), y2: y(95) }),
        svg("text", { x: left + 5, y: y(95) + 14 }, "95 %"));
    }
    const cross = svg("line", { class: "cross", y1: top, y2: y(low), visibility: "hidden" });
    root.append(cross);
    const dots = values.map((value, n) => svg("circle", { class: "dot", cx: x(n), cy: y(value), r: last > 60 ? 0 : 3 }));
    root.append(...dots);
    const hit = svg("rect", { class: "hit", x: left, y: 0, width: width - left - right + 8, height });
    root.append(hit);

    let current = -1;
    function point(n) {
      if (current > 0) links[current - 1].classList.remove("on");
      if (current >= 0) dots[current].classList.remove("on");
      current = n;
      tip.hidden = n < 0;
      cross.setAttribute("visibility", n < 0 ? "hidden" : "visible");
      if (n < 0) return;
      dots[n].classList.add("on");
      cross.setAttribute("x1", x(n));
      cross.setAttribute("x2", x(n));
      if (n > 0) {
        const [id, parsed] = data.mending[n - 1];
        const gain = parsed - (n > 1 ? data.mending[n - 2][1] : data.parsed);
        links[n - 1].classList.add("on");
        tip.replaceChildren(el("b", "", `${n}. ${clusters[indexOf.get(id)].title}`),
          `${gain < 0 ? "−" : "+"}${counted(Math.abs(gain), "file")}, then ${number(parsed)} of ${number(data.files)} parse (${percent(parsed, data.files)})`);
      } else {
        tip.replaceChildren(el("b", "", "Today"), `${number(data.parsed)} of ${number(data.files)} parse (${percent(data.parsed, data.files)})`);
      }
      const flip = x(n) > width / 2;
      tip.style.left = flip ? "auto" : `${x(n) + 12}px`;
      tip.style.right = flip ? `${width - x(n) + 12}px` : "auto";
      tip.style.top = `${Math.min(y(values[n]) + 14, height - 90)}px`;
    }
    hit.addEventListener("pointermove", (event) => {
      const offset = event.clientX - root.getBoundingClientRect().left - left;
      point(Math.min(last, Math.max(0, Math.round((offset * last) / (width - left - right)))));
    });
    hit.addEventListener("pointerleave", () => point(-1));
    hit.addEventListener("click", () => { if (current > 0) goTo(data.mending[current - 1][0]); });

    const range = total <= FIRST_STEPS ? null : el("div", "range", button(whole ? `First ${FIRST_STEPS}` : `All ${number(total)}`, () => {
      whole = !whole;
      draw();
    }));
    tip.hidden = true;
    holder.replaceChildren(root, tip, ...(range ? [range] : []));
  }

  byId("steps").addEventListener("click", (event) => {
    const link = event.target.closest("a");
    if (!link) return;
    event.preventDefault();
    goTo(link.dataset.cluster);
  });
  let drawn = 0;
  new ResizeObserver(() => {
    if (holder.clientWidth !== drawn) {
      drawn = holder.clientWidth;
      draw();
    }
  }).observe(holder);
  drawn = holder.clientWidth;
  draw();
}
