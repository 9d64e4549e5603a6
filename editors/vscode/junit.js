// Reads the test cases of a JUnit file as pytest writes it.

const ENTITIES = { lt: "<", gt: ">", quot: '"', apos: "'", amp: "&" };

const plain = (text) =>
  text.replace(/&(?:#x([0-9a-f]+)|#(\d+)|(\w+));/gi, (all, hex, number, name) =>
    hex ? String.fromCodePoint(parseInt(hex, 16)) : number ? String.fromCodePoint(Number(number)) : (ENTITIES[name] ?? all),
  );

const attribute = (head, name) => plain(new RegExp(`\\s${name}="([^"]*)"`).exec(head)?.[1] ?? "");

/** Name, milliseconds, whether it was skipped, and the message of each case that failed. */
exports.readJunit = (xml) =>
  [...xml.matchAll(/<testcase\b((?:[^>"]|"[^"]*")*?)(?:\/>|>([\s\S]*?)<\/testcase>)/g)].map(([, head, body = ""]) => {
    const failure = /<(?:failure|error)\b((?:[^>"]|"[^"]*")*?)(?:\/>|>([\s\S]*?)<\/(?:failure|error)>)/.exec(body);
    return {
      name: attribute(head, "name"),
      milliseconds: Number(attribute(head, "time")) * 1000,
      skipped: /<skipped\b/.test(body),
      message: failure ? plain(failure[2] ?? "") || attribute(failure[1], "message") : undefined,
    };
  });
