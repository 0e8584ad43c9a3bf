// What a press gives, as estimates and points of a response name it.
export const GIVEN = [
  { key: "voltage_V", name: "open-circuit voltage", unit: "V" },
  { key: "force_N", name: "force", unit: "N" },
  { key: "charge_pC", name: "charge", unit: "pC" },
];
export const given = (key) => GIVEN.find((one) => one.key === key);

// Tables whose numbers change no press, or only how finely it is solved.
const ASIDE = ["readout", "fabrication", "mesh", "seed"],
  STEPS = "press.load_steps";

// The numbers of the form that act and are shown, as their sliders tell them.
export function numbersOf(form) {
  const all = form.matches(".every"),
    shown = (slider) => !slider.hidden && !slider.closest(`.field.inert${all ? "" : ", .field.extra"}`);
  return [...form.querySelectorAll("[data-slider]")].filter(shown).flatMap(({ dataset }) => {
    const path = JSON.parse(dataset.path);
    const [now, low, high] = [dataset.now, dataset.low, dataset.high].map(Number);
    return ASIDE.includes(path[0]) || dataset.slider === STEPS || dataset.now === undefined
      ? []
      : [{ key: dataset.slider, path, name: dataset.name, unit: dataset.unit, now, low, high }];
  });
}
