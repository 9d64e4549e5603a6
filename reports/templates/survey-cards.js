// The card of a cluster: example, reproducer, expected tokens, proposals, files.

// Long sets and lists are folded, unless only a few items would be hidden.
const FOLD_AFTER = 14;
const WORTH_FOLDING = 4;
const ORIGINS_SHOWN = 6;

function example(cluster, item) {
  const at = item.column ? `${item.line}:${item.column}` : `${item.line}`;
  return el("div", "example", el("p", "place", `${strings[item.path]}:${at}`),
    sourceBlock(item.lines, { line: item.line, column: item.caret, width: item.width }));
}

function examples(cluster) {
  if (cluster.examples.length === 0) return null;
  const [first, ...others] = cluster.examples;
  return part("Example", example(cluster, first), others.length === 0 ? null
    : folded([counted(others.length, "more example")],
      () => el("div", "", ...others.map((other) => example(cluster, other)))));
}

function found(cluster) {
  return cluster.token ? part("Found", el("code", "found", ...visible(cluster.token))) : null;
}

function expected(cluster) {
  const words = cluster.expected.map((i) => el("code", "", strings[i]));
  const fold = words.length + cluster.expectedMore > FOLD_AFTER + WORTH_FOLDING;
  const first = fold ? FOLD_AFTER : words.length;
  const chips = el("div", "chips", ...words.slice(0, first));
  if (fold) {
    chips.append(button(`… ${words.length + cluster.expectedMore - first} more`, (self) => {
      self.replaceWith(...words.slice(first),
        ...(cluster.expectedMore ? [`… ${cluster.expectedMore} more in the JSON`] : []));
    }));
  }
  const title = words.length === 1 ? "Expected" : `Expected, one of ${words.length + cluster.expectedMore}`;
  return words.length ? part(title, chips) : null;
}

function rule(cluster) {
  const names = cluster.stack.map((i) => strings[i]);
  if (names.length === 0 && cluster.rule) names.push(cluster.rule);
  if (names.length === 0) return null;
  const path = el("p", "stack");
  names.forEach((name, i) => path.append(...(i ? [el("i", "", "›")] : []), el("code", "", name)));
  return part(names.length > 1 ? "Rule stack" : "Rule", path);
}

function reproducer(cluster) {
  const given = cluster.reproducer;
  if (!given) return null;
  const lines = given.text.replace(/(\r\n|\r|\n)$/, "").split(/\r\n|\r|\n/).map((text, i) => [i + 1, text]);
  const at = given.line ? { line: given.line, column: given.column, width: 1 } : null;
  const failing = at && lines[at.line - 1] ? lines[at.line - 1][1] : "";
  if (at && failing.toLowerCase().startsWith(cluster.token.toLowerCase(), at.column - 1)) {
    at.width = Math.max(1, cluster.token.length);
  }
  const tokens = given.tokens === null ? "" : `, ${counted(given.tokens, "token")}`;
  const section = part("", el("div", "heading", el("h3", "", `Reproducer${tokens}`), copyButton(given.text)));
  section.append(sourceBlock(lines, at));
  return section;
}

const VERDICTS = [
  ["restores", "Restores", "Files that parse with this edit and did not before", false],
  ["breaks", "Breaks", "Files that parsed before and do not with this edit", true],
  ["negatives", "Negatives accepted", "Programs that must stay rejected and are accepted with this edit", true],
  ["ambiguities", "Ambiguities", "New places where the grammar can read a text in two ways", true],
];

function proposals(cluster) {
  if (cluster.proposals.length === 0) return null;
  const shownVerdicts = VERDICTS.filter(([key]) => cluster.proposals.some((p) => p[key] !== null));
  const head = el("tr", "", el("th", "", "Edit"), ...shownVerdicts.map(([, name, help]) => {
    const cell = el("th", "num", name);
    cell.title = help;
    return cell;
  }));
  const body = el("tbody");
  for (const proposal of cluster.proposals) {
    const edit = [el("code", "", ...visible(proposal.edit)),
      proposal.kind ? el("span", "kind", ` ${proposal.kind}`) : null];
    body.append(el("tr", "", el("td", "", proposal.diff ? folded(edit, () => diffBlock(proposal.diff)) : edit),
      ...shownVerdicts.map(([key, name, , harm]) => {
        const value = proposal[key];
        const state = value === null || value === 0 ? " zero" : harm ? " bad" : "";
        const cell = el("td", `num${state}`, value === null ? "–" : number(value));
        cell.dataset.label = name;
        return cell;
      })));
  }
  // constructs that the start lacks are answered or proposed under the grammar in force, not here
  return part("", el("div", "heading", el("h3", "", "Proposals, the best first"),
    ...(prefix ? [] : [copyButton(`krl construct propose ${cluster.id}`, "Copy command")])),
  el("table", "proposals", el("thead", "", head), body));
}

function filesByOrigin(cluster) {
  if (cluster.byOrigin.length === 0) return null;
  const parts = cluster.byOrigin.map(([origin, leftOut, places]) => folded(
    [el("b", "", number(places.length + leftOut)), ` ${strings[origin]}`],
    () => el("ul", "paths", ...places.map(([path, line]) => el("li", "", `${strings[path]}${line ? `:${line}` : ""}`)),
      leftOut ? el("li", "more", `… ${number(leftOut)} more in the JSON of the survey`) : null)));
  const more = cluster.filesMore
    ? el("p", "stack", `… ${counted(cluster.filesMore, "more file")} in the JSON of the survey`) : null;
  const fold = parts.length > ORIGINS_SHOWN + WORTH_FOLDING;
  const first = fold ? ORIGINS_SHOWN : parts.length;
  const rest = fold ? folded([counted(parts.length - first, "more origin")],
    () => el("div", "", ...parts.slice(first))) : null;
  return part("Files by origin", ...parts.slice(0, first), rest, more);
}

function facts(cluster) {
  const line = el("span");
  const add = (value, words) => line.append(line.childNodes.length ? " · " : "", el("b", "", number(value)), ` ${words}`);
  add(cluster.unlocks, `${cluster.unlocks === 1 ? "file" : "files"} would parse if only this were mended`);
  add(cluster.files, cluster.files === 1 ? "file shows it" : "files show it");
  if (cluster.origins) add(cluster.origins, cluster.origins === 1 ? "origin" : "origins");
  add(cluster.failures, (cluster.failures === 1 ? "failure" : "failures")
    + (cluster.lines === null || cluster.lines === cluster.failures ? "" : ` on ${counted(cluster.lines, "line")}`));
  if (cluster.follows) add(cluster.follows, "only follow from an earlier failure");
  const step = data.mending.find(([id]) => id === cluster.id);
  if (step) line.append(` · place ${step[2]} in the mending order, ${percent(step[1], data.files)} parse after it`);
  const link = el("a", "at", cluster.id);
  link.href = `#${new URLSearchParams({ [`${prefix}cluster`]: cluster.id })}`;
  link.title = "Link to this cluster";
  return el("p", "facts", line, link);
}

const answerOf = (cluster) => (Object.hasOwn(data.answers, cluster.id) ? data.answers[cluster.id] : null);

/** Returns the construct that answers a cluster, with its evidence and its edit. */
function answer(cluster) {
  const construct = answerOf(cluster);
  if (!construct) return null;
  return el("div", "answered",
    el("div", "heading", el("h3", "", `Answered by ${construct.id}: `, el("b", "", construct.title)),
      copyButton(`krl construct show ${construct.id}`, "Copy command")),
    summaryOf(construct),
    el("div", "halves", el("div", "", editOf(construct)), el("div", "", evidenceOf(construct))),
    folded(["Its examples"], () => el("div", "", ...examplesOf(construct).filter(Boolean))));
}

function card(cluster) {
  return el("div", "sheet", facts(cluster), answer(cluster),
    el("div", "halves",
      el("div", "", examples(cluster), reproducer(cluster)),
      el("div", "", found(cluster), expected(cluster), rule(cluster), filesByOrigin(cluster))),
    proposals(cluster));
}
