// Numbers with their uncertainty, at the precision that it leaves, in units that people read.
const PREFIXES = [
  [1e3, "k"],
  [1, ""],
  [1e-3, "m"],
  [1e-6, "µ"],
  [1e-9, "n"],
  [1e-12, "p"],
];
const FACTORS = {
  N: [1, "N"],
  V: [1, "V"],
  pC: [1e-12, "C"],
  pF: [1e-12, "F"],
  MPa: [1e6, "Pa"],
  µm: [1e-6, "m"],
  mm: [1, "mm"],
  s: [1, "s"],
  "%": [1, "%"],
};
const BARE = ["%", "mm"];
const LARGE = [
  [1e9, "G"],
  [1e6, "M"],
];

// The unit in which a value has one to three digits before its point, and the value of one of it.
/** @returns {[number, string]} */
function unitOf(value, unit) {
  const [factor, base] = FACTORS[unit] || [1, unit];
  if (BARE.includes(base) || !value) return [1, unit];
  const size = Math.abs(value) * factor;
  if (factor === 1 && size >= 0.1 && size < 1) return [1, unit];
  const prefixes = base === "Pa" ? [...LARGE, ...PREFIXES] : PREFIXES;
  const found = prefixes.find(([one]) => size >= 0.9995 * Number(one)) || prefixes[prefixes.length - 1];
  return [Number(found[0]) / factor, found[1] + base];
}

const minus = (text) => text.replace("-", "−");

// Decimals that show a value to so many significant digits.
const decimals = (value, digits) =>
  value ? Math.max(0, digits - 1 - Math.floor(Math.log10(Math.abs(value)) + 1e-9)) : 0;

function rounded(value, digits) {
  const large = Math.abs(value) >= 10 ** digits ? Number(value.toPrecision(digits)) : value;
  return minus(large.toFixed(decimals(value, digits)));
}

// Significant digits of an uncertainty (ISO/IEC Guide 98-3, 7.2.6: at most two).
const ERROR_DIGITS = 2;

// "62 ± 16 V"; without an error so many digits: "8.2 mV".
export function quantity(value, unit, error = null, digits = 3) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (!error) {
    const [size, name] = unitOf(value, unit);
    return `${rounded(value / size, digits)}\u00a0${name}`;
  }
  const [size, name] = unitOf(Math.max(Math.abs(value), error), unit),
    told = ERROR_DIGITS;
  const places = decimals(Number((error / size).toPrecision(told)), told),
    coarse = 10 ** Math.max(0, Math.floor(Math.log10(error / size)) + 1 - told);
  const text = (one) => minus((Math.round(one / size / coarse) * coarse).toFixed(places));
  const shown = coarse > 1 ? text : (one) => minus((one / size).toFixed(places));
  return `${shown(value)}\u2009±\u2009${shown(error)}\u00a0${name}`;
}

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
