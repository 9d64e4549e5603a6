// A construct of the ledger: its description, evidence, edits and examples.

const GROUNDS = {
  corroborated: "Two or more independent origins show it",
  documented: "A documented rule or a manual says so",
  confirmed: "The official implementation accepted it",
};

function groundTags(grounds) {
  return grounds.map((ground) => {
    const tag = el("span", `ground ${ground}`, ground);
    tag.title = GROUNDS[ground] ?? "";
    return tag;
  });
}

function summaryOf(construct) {
  return construct.summary ? el("p", "summary", construct.summary) : null;
}

function editOf(construct) {
  if (!construct.diff && !construct.edits.length) return null;
  const words = construct.edits.length
    ? folded([counted(construct.edits.length, "typed edit")], () => el("ol", "edits", ...construct.edits.map((edit) => el("li", "", el("code", "", edit)))))
    : null;
  return part("Edit of the grammar", construct.diff ? diffBlock(construct.diff) : null, words);
}

function evidenceOf(construct) {
  const { files, origins, lines, rules, manual, verdict, oracle, seen } = construct.evidence;
  const rows = [];
  const row = (name, ...content) => rows.push(el("dt", "", name), el("dd", "", ...content));
  if (construct.grounds.length) row("Grounds", el("span", "grounds", ...groundTags(construct.grounds)));
  if (files) row("Seen", `${counted(lines, "line")} in ${counted(files, "file")} of ${counted(origins, "origin")}`);
  if (rules.length) row("Rules", el("span", "chips", ...rules.map((rule) => el("code", "", rule))));
  if (manual) row("Manual", manual);
  if (verdict) row("Verdict", verdict, oracle ? el("span", "dim", ` (${oracle})`) : null);
  if (!rows.length) return null;
  const places = seen.length
    ? folded(["first places"], () => el("ul", "paths one", ...seen.map((place) => el("li", "", place)))) : null;
  return part("Evidence", el("dl", "evidence", ...rows), places);
}

function program(text) {
  const lines = text.replace(/(\r\n|\r|\n)$/, "").split(/\r\n|\r|\n/);
  return sourceBlock(lines.map((line, i) => [i + 1, line]), null);
}

const SHOWN_AT_ONCE = 1;
function examplesOf(construct) {
  const list = (title, programs) => {
    if (!programs.length) return null;
    const rest = programs.slice(SHOWN_AT_ONCE);
    return part(title, ...programs.slice(0, SHOWN_AT_ONCE).map(program),
      rest.length ? folded([counted(rest.length, "more program")], () => el("div", "programs", ...rest.map(program))) : null);
  };
  return [list("Accepted since", construct.accept), list("Still refused", construct.reject)];
}
