// One control for each kind of value: choice, switch, number with its slider, lists, text.
import { element, short } from "./dom.js";
import { numberOf } from "./numbers.js";

const SLIDER_STEPS = 1000;
const dotted = (path) =>
  path
    .map((part) => (typeof part === "number" ? `[${part}]` : "." + part))
    .join("")
    .slice(1);

// Calls done when a field has been filled; returns whether somebody is typing in it, so that it is left alone. What is
// typed is undone by the browser, what has been taken over by the design.
function typing(input, done, ask) {
  let busy = false;
  input.addEventListener("input", () => {
    busy = true;
  });
  input.addEventListener("change", () => {
    busy = false;
    done();
  });
  input.addEventListener("keydown", (event) => {
    const name = { z: event.shiftKey ? "redo" : "undo", y: "redo" }[event.key.toLowerCase()];
    if (busy || !(event.ctrlKey || event.metaKey) || !name) return;
    event.preventDefault();
    event.stopPropagation();
    ask({ do: name });
  });
  return () => busy && document.activeElement === input;
}

// From a place on a slider to a value and back; sizes are spaced by their ratios.
function scaled(found, value, whole) {
  const low = found.minimum ?? found.exclusiveMinimum,
    high = found.maximum ?? found.exclusiveMaximum;
  const rounded = (one) => (whole ? Math.round(one) : Number(one.toPrecision(3)));
  const bounded = low !== undefined && high !== undefined && high - low <= 100;
  if (!bounded && low !== undefined && low >= 0 && value > 0) {
    const [a, b] = [Math.max(value / 8, whole ? 1 : 0), Math.min(value * 8, high ?? Infinity)];
    const place = (one) => (SLIDER_STEPS * Math.log(one / a)) / Math.log(b / a);
    return { low: a, high: b, value: (at) => rounded(a * (b / a) ** (at / SLIDER_STEPS)), place };
  }
  const reach = Math.max(2 * Math.abs(value), 1);
  const [a, b] = bounded
    ? [low, high]
    : [Math.max(-reach, low ?? -Infinity), Math.min(reach, high ?? Infinity)];
  const inner = bounded && found.exclusiveMinimum !== undefined ? a + (b - a) / SLIDER_STEPS : a;
  const place = (one) => (SLIDER_STEPS * (one - inner)) / (b - inner);
  return { low: a, high: b, value: (at) => rounded(inner + ((b - inner) * at) / SLIDER_STEPS), place };
}

// form: has about, set(path, value, joined), ask; name: what a person calls the value. A control has parts (its
// elements), single (one label is enough), show(value), and may have slider and about() (words on what is chosen).
export function control(form, found, path, id, name) {
  const key = path[path.length - 1],
    { about } = form;
  if (key === "material") {
    const film = path.includes("film"),
      fits = (one) => (one.is === "piezoelectric-film") === film;
    const names = about.materials.filter(fits).map((one) => one.name);
    return choice(form, names, path, id, (chosen) => source(about.materials, chosen));
  }
  if (key === "standard") {
    const names = ["", ...about.standards.map((one) => one.name)];
    return choice(form, names, path, id, (chosen) => source(about.standards, chosen));
  }
  if (found.enum) return choice(form, found.enum, path, id);
  if (found.type === "boolean") return checkbox(form, path, id);
  if (found.type === "number" || found.type === "integer") return number(form, found, path, id, name);
  if (found.prefixItems) return pair(form, found, path, id, name);
  if (found.items && found.items.enum) return several(form, found, path);
  return text(form, found, path, id);
}

function source(list, name) {
  const one = list.find((each) => each.name === name);
  return one ? `${one.is}; source: ${one.source} (confidence ${one.confidence})` : "";
}

function choice(form, options, path, id, about) {
  const numbers = typeof options[0] === "number";
  const value = () => (select.value === "" ? null : numbers ? Number(select.value) : select.value);
  const select = element("select", { id, onchange: () => form.set(path, value()) });
  const show = (given) => {
    const names = [...options];
    if (given !== undefined && given !== null && !names.includes(given)) names.push(given);
    if (select.options.length !== names.length) {
      const words = (one) => (one === "" ? "not stated" : String(one));
      select.replaceChildren(...names.map((one) => element("option", { value: String(one) }, words(one))));
    }
    select.value = given === null || given === undefined ? "" : String(given);
  };
  return { single: true, parts: [select], show, about: about && (() => about(select.value)) };
}

function checkbox(form, path, id) {
  const box = element("input", { type: "checkbox", id, onchange: () => form.set(path, box.checked) });
  return {
    single: true,
    parts: [box],
    show: (value) => {
      box.checked = Boolean(value);
    },
  };
}

function number(form, found, path, id, name) {
  const whole = found.type === "integer",
    placeholder = found.optional ? "none" : "";
  const input = element("input", { type: "text", class: "number", inputmode: "decimal", id, placeholder });
  const slider = element("input", {
    type: "range",
    min: 0,
    max: SLIDER_STEPS,
    step: 5,
    "aria-label": `${name}, slider`,
  });
  slider.dataset.slider = dotted(path);
  slider.dataset.path = JSON.stringify(path);
  slider.dataset.name = name;
  let scale = null,
    held = false,
    waiting = null;
  const typed = typing(input, () => form.set(path, numberOf(input.value)), form.ask);
  slider.addEventListener("input", () => {
    const value = scale.value(Number(slider.value));
    input.value = value;
    slider.setAttribute("aria-valuetext", short(value));
    if (!held) form.set(path, value, false);
    else if (waiting === null) {
      waiting = requestAnimationFrame(() => {
        waiting = null;
        form.set(path, numberOf(input.value), true);
      });
    }
    held = true;
  });
  slider.addEventListener("change", () => {
    held = false;
  });
  const show = (value) => {
    const stated = value !== null && value !== undefined;
    slider.hidden = typeof value !== "number";
    if (held) return;
    if (!typed()) input.value = stated ? value : "";
    if (slider.hidden) return;
    if (!scale || value < scale.low || value > scale.high) scale = scaled(found, value, whole);
    slider.value = scale.place(value);
    slider.setAttribute("aria-valuetext", short(value));
    Object.assign(slider.dataset, { now: value, low: scale.low, high: scale.high });
  };
  return { single: true, parts: [input], slider, show };
}

function pair(form, found, path, id, name) {
  const inputs = found.prefixItems.map((one, i) => {
    const names = one.enum,
      options = (names || []).map((each) => element("option", { value: each }, each));
    const made = names
      ? element("select", {}, ...options)
      : element("input", { type: "text", class: "number", inputmode: "decimal" });
    made.setAttribute("aria-label", `${name}, ${"xyz"[i] || i + 1}`);
    const value = () => inputs.map((each) => (names ? each.value : numberOf(each.value)));
    made.addEventListener("change", () => form.set(path, value()));
    return made;
  });
  inputs[0].id = id;
  const show = (value) =>
    inputs.forEach((one, i) => {
      if (value && document.activeElement !== one) one.value = value[i];
    });
  return { single: false, parts: inputs, show };
}

function several(form, found, path) {
  const chosen = () => boxes.filter((one) => one.checked).map((one) => one.value);
  const made = (name) =>
    element("input", { type: "checkbox", value: name, onchange: () => form.set(path, chosen()) });
  const boxes = found.items.enum.map(made);
  const labels = boxes.map((box) => element("label", {}, box, box.value));
  const show = (value) =>
    boxes.forEach((box) => {
      box.checked = (value || []).includes(box.value);
    });
  return { single: false, parts: [element("span", { class: "checks" }, ...labels)], show };
}

// Texts, and lists of numbers as JSON writes them.
function text(form, found, path, id) {
  const listed = found.type === "array",
    input = element("input", { type: "text", id });
  const typed = typing(
    input,
    () => {
      let value = input.value === "" ? null : input.value;
      if (listed && value !== null) {
        try {
          value = JSON.parse(/^\s*\[/.test(value) ? value : `[${value}]`);
        } catch {
          /* the program says what is wrong */
        }
      }
      form.set(path, value);
    },
    form.ask,
  );
  const words = (value) =>
    value === null || value === undefined ? "" : listed ? JSON.stringify(value) : value;
  return {
    single: true,
    parts: [input],
    show: (value) => {
      if (!typed()) input.value = words(value);
    },
  };
}
