// The sections of the survey page: the grammar in force and, if it was surveyed too, the restrictive
// start. Each has the same elements, whose ids begin with its prefix.

const states = {};

function writeHash() {
  const set = Object.entries(states).flatMap(([prefix, state]) =>
    Object.entries(state).filter(([, value]) => value).map(([key, value]) => [prefix + key, value]));
  setHash(String(new URLSearchParams(set)));
}

const readers = page.sections.map((section) => present(section, section.prefix)).filter(Boolean);

/** Lets all sections read the hash before one of them writes it. */
function readHash() {
  const given = new URLSearchParams(location.hash.slice(1));
  for (const read of readers) read(given);
  if (Object.values(states).some((state) => Object.values(state).some(Boolean))) writeHash();
}
readHash();
addEventListener("hashchange", readHash);

document.addEventListener("keydown", (event) => {
  const search = document.querySelector("input[type=search]");
  if (event.key === "/" && search && !/^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName)) {
    event.preventDefault();
    search.focus();
  }
});
