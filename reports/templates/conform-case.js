// A case: its rule, its source with expected and actual values, its results, timing and path.

const verdictMark = (verdict) => el("span", `v ${verdict}`, verdict);

function caseSource(one, result) {
  const checks = new Map();
  for (const check of result?.checks ?? []) {
    const key = `${check.file}:${check.line}`;
    if (!checks.has(key)) checks.set(key, []);
    checks.get(key).push(check);
  }
  const where = result?.divergence?.at ?? result?.divergence?.place ?? "";
  return one.files.map((file) => part(file.name, el("pre", "source case-source", file.lines.map((text, n) => {
    const found = checks.get(`${file.name}:${n + 1}`) ?? [];
    const unmet = found.filter((check) => check.state === "unmet");
    const state = unmet.length ? " unmet" : found.some((check) => check.state === "met") ? " met" : "";
    const here = where === `${file.name}:${n + 1}` ? " here" : "";
    const cut = text.search(/;[@>]/);
    const words = cut < 0 ? [text || " "] : [text.slice(0, cut), el("span", text[cut + 1] === ">" ? "expect" : "front", text.slice(cut))];
    const line = el("span", "tx", words);
    for (const check of unmet) line.append(el("span", "seen", `↑ seen: ${check.actual || "nothing"}`));
    return el("div", `l${state}${here}`, el("span", "no", String(n + 1)), line);
  }))));
}

function resultTable(one) {
  const rows = one.results.map((result) => el("tr", "", el("td", "", verdictMark(result.verdict)),
    el("td", "", `${result.executor} · ${result.robot}`), el("td", "", result.ending), el("td", "dim", result.reason)));
  return part("Results", el("table", "results", el("tbody", "", rows)));
}

function divergence(result) {
  if (!result.divergence) return null;
  const told = Object.entries(result.divergence).map(([name, value]) => `${name}: ${typeof value === "string" ? value : JSON.stringify(value)}`);
  return el("div", "diverges", el("b", "", `${result.executor} ${result.robot} differs first here`), el("pre", "", told.join("\n")));
}

function eventList(result) {
  const rows = result.events.map((event) => {
    const { t, kind, at, task, ...rest } = event;
    return `${t === null || t === undefined ? "" : (t / 1e6).toFixed(6).padStart(12)}  ${kind.padEnd(16)} ${(at ?? "").padEnd(24)} ${Object.entries(rest).map(([k, v]) => `${k}=${typeof v === "object" ? JSON.stringify(v) : v}`).join(" ")}${task === "submit" ? " (submit)" : ""}`;
  });
  if (result.eventsTotal > rows.length) rows.push(`… ${number(result.eventsTotal)} events in all, statements included`);
  return folded([`Events (${result.executor} ${result.robot})`], () => el("pre", "source bare", rows.join("\n")));
}

/** Returns the element of a case and the functions that draw its charts once it is in the page. */
function caseSheet(one) {
  const failing = one.results.find((result) => result.verdict === "fail")
    ?? one.results.find((result) => result.verdict !== "skipped") ?? one.results[0];
  const full = one.results.find((result) => result.events.length) ?? failing;
  const drawn = [full ? timing(full.events) : null, overlay(one.results, failing?.checks ?? [])].filter((found) => found !== null);
  const rules = one.rules.map((id) => {
    const rule = page.rules[id];
    return el("p", "rule-text", el("b", "", id), rule ? ` ${rule.statement} ` : " ", rule ? el("span", "dim", `(tier ${rule.tier}${rule.mayFail ? "" : ", may not fail a case"}${rule.source.length > 1 ? `; ${rule.source}` : ""})`) : null);
  });
  const facts = [one.phase, one.profile, one.negative ? "negative" : "", ...one.io.map((line) => `io ${line}`)].filter(Boolean).join(" · ");
  const sheet = el("div", "sheet",
    el("div", "facts", el("span", "", facts), copyButton(one.name, "Copy name")),
    one.isShort ? el("p", "hint", `Left out, as this page would be too large: source and events. krl conform ${one.name} --html DIR shows them.`) : null,
    ...rules,
    one.unconfirmed ? el("p", "hint", `Unconfirmed: ${one.unconfirmed}`) : null,
    el("div", "duo", el("div", "", ...caseSource(one, failing)),
      el("div", "", resultTable(one), ...one.results.map(divergence).filter(Boolean), ...drawn.map(([section]) => section),
        ...one.results.filter((result) => result.findings.length).slice(0, 1).map((result) => part("Findings", el("pre", "source bare", result.findings.map((found) => `${found.file}:${found.line}: ${found.code} ${found.message}`).join("\n")))),
        ...one.results.filter((result) => result.events.length).map(eventList))));
  return [sheet, drawn.map(([, draw]) => draw)];
}
