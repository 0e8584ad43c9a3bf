// The middle: how far the press is, its numbers with error bars, circuit.
import { channel } from "./charts.js";
import { element, find } from "./dom.js";
import { quantity } from "./numbers.js";

// What is shown of a press: key of its course, title and unit, key of its uncertainty, and what estimates call it.
const QUANTITIES = [
  { key: "reaction_force_N", title: "Force", unit: "N", percent: "force_percent", given: "force_N" },
  { key: "film_charge_pC", title: "Charge", unit: "pC", percent: "charge_percent", given: "charge_pC" },
  {
    key: "open_circuit_voltage_V",
    title: "Open circuit",
    unit: "V",
    percent: "voltage_percent",
    given: "voltage_V",
  },
];
const COARSE_DIGITS = 2,
  CIRCUIT_DIGITS = 4;
const last = (values) => (values && values.length ? values[values.length - 1] : null);

// What the program says of the press.
export function doing(text, busy, bad = false) {
  find("#press .doing").textContent = text;
  find("#press").classList.toggle("bad", bad);
  find("#press .cancel").hidden = !busy;
}

// Absolute error of a value and what it is of: the whole uncertainty, that of the mesh, or none.
function off(numbers, percent, value) {
  const whole = (numbers.uncertainty || {})[percent],
    mesh = (numbers.discretisation_error || {})[percent];
  const of = (share) => Math.abs((share / 100) * value);
  if (whole !== undefined) return [of(whole), "materials + mesh", `the mesh alone: ${mesh.toPrecision(2)} %`];
  if (mesh !== undefined) return [of(mesh), "mesh alone"];
  return [null, numbers.uncertainty ? "" : "error bars follow"];
}

function card(numbers, quality, { key, title, unit, percent }) {
  const value = last(numbers[key]);
  if (quality === "coarse") {
    return { title, value: quantity(value, unit, null, COARSE_DIGITS), words: "coarse, some percent off" };
  }
  const [error, words, more] = off(numbers, percent, value);
  return { title, value: quantity(value, unit, error), words, more };
}

// Of a design that is not pressed yet, from the derivatives of one that is, or by a family.
function estimated({ value, error }, { title, unit }, by) {
  return {
    title,
    value: quantity(value, unit, error),
    words: "estimate",
    more: by === "family" ? "by the family, with its interval" : "to first order from a press before",
    fresh: true,
  };
}

// What a press gives at full load, as goals and estimates name it.
export const atFullLoad = (numbers) =>
  Object.fromEntries(QUANTITIES.map(({ key, given }) => [given, last(numbers[key])]));

// The last press, and the estimate for the present design where there is one.
export function show({ numbers, quality }, estimate) {
  const readout = last(numbers.readout_voltage_V),
    film = numbers.film || {};
  const cards = QUANTITIES.map((one) =>
    estimate ? estimated(estimate[one.given], one, estimate.by) : card(numbers, quality, one),
  );
  if (readout !== null) cards.push({ title: "At the amplifier", value: quantity(readout, "V"), words: "" });
  const stress = quantity(film.max_principal_stress_MPa, "MPa"),
    capacitance = quantity(film.capacitance_pF, "pF");
  const strain = quantity(100 * film.max_principal_strain, "%");
  cards.push({ title: "Film strain", value: strain, words: `${stress}; ${capacitance}` });
  const least = (numbers.sensitivity || {}).least_detectable_indentation_um;
  if (least !== null && least !== undefined) {
    const noise = quantity(numbers.sensitivity.noise_V, "V", null, 2);
    cards.push({
      title: "Least depth seen",
      value: quantity(least, "µm", null, 2),
      words: `of noise ${noise}`,
    });
  }
  const made = ({ title, value, words, more, fresh }) =>
    element(
      "div",
      { title: more || words, class: fresh ? "fresh" : null },
      element("dt", {}, title),
      element("dd", {}, value, element("small", {}, words)),
    );
  find("#numbers").replaceChildren(...cards.map(made));
}

const volts = (value) => quantity(value, "V", null, CIRCUIT_DIGITS);

export function circuit(found) {
  const place = find("#circuit .answer");
  if (!found) {
    place.replaceChildren(
      element("p", { class: "soft" }, "Open circuit: switch an amplifier on to see what it reads."),
    );
    return;
  }
  const most = found.voltage_V.reduce((a, b) => (Math.abs(b) > Math.abs(a) ? b : a), 0);
  const at = { title: "At the amplifier", unit: "V", x: found.time_s, y: found.voltage_V, bands: [] };
  place.replaceChildren(
    element(
      "p",
      {},
      `At full load ${volts(last(found.readout_voltage_V))}; largest over the press ${volts(most)}.`,
    ),
    channel({ ...at, width: 560, height: 170 }),
  );
}
