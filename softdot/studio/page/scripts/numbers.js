// Numbers as people type them.

// What a text means: null where it is empty, a number, or the text itself, of which the program says what is wrong.
export function numberOf(text) {
  const plain = text
    .trim()
    .replace(/^[\u2212\u2013]/, "-")
    .replace(/^([^.,]*),([^.,]*)$/, "$1.$2");
  if (plain === "") return null;
  const value = Number(plain);
  return Number.isFinite(value) ? value : text.trim();
}
