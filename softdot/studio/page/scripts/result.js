// The middle: how far the press is, its numbers with error bars, circuit.
import { channel } from "./charts.js";
import { element, find } from "./dom.js";
import { quantity } from "./numbers.js";

const QUANTITIES = [
  ["reaction_force_N", "Force", "N", "force_percent"],
  ["film_charge_pC", "Charge", "pC", "charge_percent"],
  ["open_circuit_voltage_V", "Open circuit", "V", "voltage_percent"],
];
const COARSE_DIGITS = 2;
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

function card(numbers, quality, [key, title, unit, percent]) {
  const value = last(numbers[key]);
  if (quality === "coarse")
    return [title, quantity(value, unit, null, COARSE_DIGITS), "coarse, some percent off"];
  const [error, words, more] = off(numbers, percent, value);
  return [title, quantity(value, unit, error), words, more];
}

export function show({ numbers, quality }) {
  const readout = last(numbers.readout_voltage_V),
    film = numbers.film || {};
  const cards = QUANTITIES.map((one) => card(numbers, quality, one));
  if (readout !== null) cards.push(["At the amplifier", quantity(readout, "V"), ""]);
  const stress = quantity(film.max_principal_stress_MPa, "MPa"),
    capacitance = quantity(film.capacitance_pF, "pF");
  cards.push(["Film strain", quantity(100 * film.max_principal_strain, "%"), `${stress}; ${capacitance}`]);
  const least = (numbers.sensitivity || {}).least_detectable_indentation_um;
  if (least !== null && least !== undefined) {
    cards.push([
      "Least depth seen",
      quantity(least, "µm", null, 2),
      `of noise ${quantity(numbers.sensitivity.noise_V, "V", null, 2)}`,
    ]);
  }
  find("#numbers").replaceChildren(
    ...cards.map(([title, value, words, more]) =>
      element(
        "div",
        { title: more || words },
        element("dt", {}, title),
        element("dd", {}, value, element("small", {}, words)),
      ),
    ),
  );
}

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
      `At full load ${quantity(last(found.readout_voltage_V), "V")}; largest over the press ${quantity(most, "V")}.`,
    ),
    channel({ ...at, width: 560, height: 170 }),
  );
}
