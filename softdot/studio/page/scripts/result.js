// The middle: how far the press is, its numbers with error bars, curves, circuit.
import { curves } from "./charts.js";
import { duration, element, find, short } from "./dom.js";

const QUANTITIES = [
  ["reaction_force_N", "Force", "N", "force_percent"],
  ["film_charge_pC", "Charge", "pC", null],
  ["open_circuit_voltage_V", "Open circuit", "V", "voltage_percent"],
];
const last = (values) => (values && values.length ? values[values.length - 1] : null);

export function progress(told) {
  const bar = find("#press progress");
  const text = told.stage === "press" && told.count ? `load step ${told.done} of ${told.count}` : told.stage === "error bars" ? "error bars" : told.stage;
  const left = told.left_s === null || told.left_s === undefined || !told.count ? "" : `, ${duration(told.left_s)} left`;
  doing(`Pressing: ${text}${left}`, true);
  bar.hidden = false;
  if (told.count) bar.value = told.done / told.count;
  else bar.removeAttribute("value");
}

export function doing(text, busy, bad = false) {
  find("#press .doing").textContent = text;
  find("#press").classList.toggle("bad", bad);
  find("#press .cancel").hidden = !busy;
  if (busy) find("#press .again").hidden = true;
  if (!busy) find("#press progress").hidden = true;
}

export function ended(told, state) {
  find("#press .again").hidden = !told.said;
  if (told.said) doing(told.said === "cancelled" ? "The press was cancelled." : told.said, false, Boolean(told.bad));
  else if (state.ofArray) doing("Pressed on large elements. Report and CAD is softdot array, as fine as the design asks for.", false);
  else doing(state.quality === "accurate" ? "Pressed, as softdot run does." : "Pressed.", false);
}

function plusMinus(numbers, percent, value) {
  const whole = numbers.uncertainty || {}, mesh = numbers.discretisation_error || {};
  if (!percent || value === null) return "";
  const off = (share) => `±${Number(Math.abs((share / 100) * value).toPrecision(2))}`;
  if (whole[percent] !== undefined) return `${off(whole[percent])}: materials and mesh; ${off(mesh[percent])}: mesh alone`;
  if (mesh[percent] !== undefined) return `${off(mesh[percent])}: mesh alone`;
  return "error bars follow";
}

export function show(list) {
  const now = list[list.length - 1], { numbers } = now, readout = last(numbers.readout_voltage_V);
  const cards = QUANTITIES.map(([key, title, unit, percent]) => [title, `${short(last(numbers[key]))} ${unit}`, now.quality === "coarse" ? "coarse, some percent off" : plusMinus(numbers, percent, last(numbers[key]))]);
  if (readout !== null) cards.push(["At the amplifier", `${short(readout)} V`, ""]);
  const film = numbers.film || {}, capacitance = film.capacitance_pF;
  cards.push(["Film strain", `${short(100 * film.max_principal_strain)} %`, `${short(film.max_principal_stress_MPa)} MPa; ${short(capacitance)} pF`]);
  const least = (numbers.sensitivity || {}).least_detectable_indentation_um;
  if (least !== null && least !== undefined) cards.push(["Least depth seen", `${short(least)} µm`, `of noise ${short(1e3 * numbers.sensitivity.noise_V)} mV`]);
  find("#numbers").replaceChildren(...cards.map(([title, value, more]) => element("div", {}, element("dt", {}, title), element("dd", {}, value, element("small", {}, more)))));
  find("#curves").replaceChildren(...QUANTITIES.map(([key, title, unit, percent]) => {
    const error = percent && numbers.uncertainty && numbers.uncertainty[percent] ? (numbers.uncertainty[percent] / 100) * Math.abs(last(numbers[key])) : 0;
    const series = list.map((one, i) => ({ x: one.numbers.indentation_mm, y: one.numbers[key], kind: i === list.length - 1 ? "now" : "faint", error: i === list.length - 1 ? error : 0 }));
    return curves({ title: title === "Open circuit" ? "Open-circuit voltage" : title, xLabel: "depth (mm)", yLabel: unit, series });
  }));
  const named = list.map((one, i) => element("li", { class: i === list.length - 1 ? "now" : "" }, `${one.label}: ${short(last(one.numbers.open_circuit_voltage_V))} V, ${short(last(one.numbers.reaction_force_N))} N` + (one.quality === "coarse" ? " (coarse)" : "") + (one.numbers.solver.converged ? "" : ` – not converged: ${one.numbers.solver.failure}`)));
  find("#designs").replaceChildren(...named);
}

export function circuit(found) {
  const place = find("#circuit .answer");
  if (!found) {
    place.replaceChildren(element("p", { class: "soft" }, "Open circuit: switch an amplifier on to see what it reads."));
    return;
  }
  const series = [{ x: found.time_s, y: found.voltage_V, kind: "now" }];
  const most = found.voltage_V.reduce((a, b) => (Math.abs(b) > Math.abs(a) ? b : a), 0);
  place.replaceChildren(
    element("p", {}, `At full load ${short(last(found.readout_voltage_V))} V; largest over the press ${short(most)} V.`),
    curves({ title: "At the amplifier", xLabel: "time (s)", yLabel: "V", series, width: 560, height: 170, marks: false }),
  );
}
