// The form, made from the schema of the configuration: a new key appears by itself.
import { element, short, worded } from "./dom.js";
import { numberOf } from "./numbers.js";

const OPEN = ["segment", "effector", "medium1", "film", "medium2", "press", "dot"];
const NAMES = { medium1: "Medium 1", medium2: "Medium 2", readout: "Amplifier" };
const at = (values, path) => path.reduce((found, part) => (found === null || found === undefined ? undefined : found[part]), values);
const dotted = (path) => path.map((part) => (typeof part === "number" ? `[${part}]` : "." + part)).join("").slice(1);
const titled = (name) => NAMES[name] || (name[0].toUpperCase() + name.slice(1)).replaceAll("_", " ");
let count = 0;

export class Form {
  // about: what the program says of its configuration; ask(message): tells the program.
  constructor(about, ask) {
    this.about = about;
    this.ask = ask;
    this.updaters = new Set();
    this.values = {};
    this.stated = {};
    this.mistakes = [];
  }

  resolved(schema) {
    const named = (one) => (one.$ref ? { ...this.about.schema.$defs[one.$ref.split("/").pop()], description: one.description } : one);
    const some = (schema.anyOf || [schema]).filter((one) => one.type !== "null");
    return { ...named(some[0]), description: schema.description, optional: Boolean(schema.anyOf), default: schema.default, actsWith: schema["x-acts-with"] || [] };
  }

  // Whether a key acts beside the values of its table: of each condition one tag has one of its values, or is there.
  acts(found, path) {
    const table = at(this.values, path.slice(0, -1)) || {};
    const has = (value, wanted) => Array.isArray(wanted) ? wanted.includes(value) : (value !== undefined && value !== null) === (wanted === "stated");
    return found.actsWith.every((tags) => Object.entries(tags).some(([key, wanted]) => has(table[key], wanted)));
  }

  update(values, stated, mistakes) {
    if (values) this.values = values;
    if (stated) this.stated = stated;
    this.mistakes = mistakes;
    for (const updater of [...this.updaters]) updater();
  }

  // Runs now and at every update, as long as its element is in the page.
  follow(anchor, updater) {
    const guarded = () => (anchor.isConnected || !anchor.wasConnected ? updater() : this.updaters.delete(guarded));
    this.updaters.add(() => {
      if (anchor.isConnected) anchor.wasConnected = true;
      guarded();
    });
    updater();
  }

  whole() {
    const { properties } = this.about.schema;
    const groups = [];
    for (const [name, schema] of Object.entries(properties)) {
      if (name === "materials") continue;
      if (name === "mechanisms") groups.push(this.group("Mechanisms", schema.description, this.mechanisms(), false));
      else if (name === "seed") groups.push(this.field(schema, [name]));
      else groups.push(this.table(schema, [name]));
    }
    return groups;
  }

  group(title, about, content, open) {
    const said = about ? element("p", { class: "soft" }, about) : null;
    return element("details", { open }, element("summary", {}, title), said, ...content);
  }

  // A table of the configuration: its values, then its tables. One that may be left out has a switch.
  table(schema, path) {
    const found = this.resolved(schema), name = path[path.length - 1], content = element("div");
    const rebuild = () => content.replaceChildren(...(at(this.values, path) ? this.rows(found, path) : []));
    const parts = [content];
    if (found.optional) {
      const box = element("input", { type: "checkbox", onchange: () => this.set(path, box.checked ? {} : null) });
      parts.unshift(element("label", { class: "switch" }, box, `with ${titled(String(name)).toLowerCase()}`));
      let shown = null;
      this.follow(content, () => {
        const there = Boolean(at(this.values, path));
        box.checked = there;
        if (there !== shown) rebuild();
        shown = there;
      });
    } else content.replaceChildren(...this.rows(found, path));
    return this.group(titled(String(name)), found.description, parts, OPEN.includes(name));
  }

  rows(found, path) {
    const plain = [], tables = [];
    for (const [name, schema] of Object.entries(found.properties)) {
      const inner = this.resolved(schema), way = [...path, name];
      if (inner.properties) tables.push(this.table(schema, way));
      else if (inner.type === "array" && inner.items && inner.items.$ref) tables.push(this.list(inner, way));
      else if (inner.type !== "object") plain.push(this.field(schema, way));
    }
    return [...plain, ...tables];
  }

  // Tables that may be repeated.
  list(found, path) {
    const content = element("div");
    const kind = this.resolved(found.items), name = titled(String(path[path.length - 1]));
    let length = null;
    this.follow(content, () => {
      const items = at(this.values, path) || [];
      if (items.length === length) return;
      length = items.length;
      const blocks = items.map((_, i) => element("div", { class: "items" }, ...this.rows(kind, [...path, i]),
        element("button", { type: "button", onclick: () => this.set([...path, i], null) }, `Remove ${name.toLowerCase()} ${i + 1}`)));
      const add = () => this.set([...path, items.length], this.starting(kind));
      content.replaceChildren(...blocks, element("button", { type: "button", onclick: add }, "Add one"));
    });
    return this.group(name, found.description, [content], false);
  }

  starting(kind) {
    const found = {};
    for (const [name, schema] of Object.entries(kind.properties)) {
      if (!(kind.required || []).includes(name)) continue;
      const one = this.resolved(schema), positive = (part) => ("exclusiveMinimum" in part ? 1 : 0);
      if (one.prefixItems) found[name] = one.prefixItems.map((part, i) => (part.enum ? part.enum[i] : positive(part)));
      else found[name] = one.enum ? one.enum[0] : one.type === "string" ? "one" : one.type === "array" ? [] : 1;
    }
    return found;
  }

  set(path, value, joined = false) {
    this.ask({ do: "set", key: path, value, joined });
  }

  // One key: its name, control, unit and the sentence that explains it.
  field(schema, path) {
    const found = this.resolved(schema), key = String(path[path.length - 1]), id = `field-${++count}`;
    const [words, unit] = worded(key, this.about.units);
    const hint = element("p", { class: "about", id: `${id}-about` }, found.description || "");
    const box = element("div", { class: "field" }, "");
    const control = this.control(found, path, id);
    const name = element("span", { class: "name" }, words);
    const head = control.single ? element("label", { for: id }, name, element("span", { class: "control" }, ...control.parts, element("span", { class: "unit" }, unit)))
      : element("div", { class: "label", role: "group", "aria-label": words }, name, element("span", { class: "control" }, ...control.parts, element("span", { class: "unit" }, unit)));
    box.replaceChildren(head, ...(control.below || []), hint);
    for (const part of control.parts) if (part.matches("input, select")) part.setAttribute("aria-describedby", hint.id);
    const start = dotted(path);
    box.dataset.key = start;
    this.follow(box, () => {
      const value = at(this.values, path);
      box.hidden = !this.acts(found, path) && at(this.stated, path) === undefined;
      control.show(value === undefined ? found.default : value);
      const bad = this.mistakes.some((one) => one.startsWith(start) && !/[\w.]/.test(one[start.length] || " "));
      box.classList.toggle("bad", bad);
      box.classList.toggle("stated", at(this.stated, path) !== undefined);
      for (const part of control.parts) part.setAttribute("aria-invalid", String(bad));
      if (control.about) hint.textContent = [found.description, control.about()].filter(Boolean).join(". ");
    });
    return box;
  }

  control(found, path, id) {
    const key = path[path.length - 1];
    if (key === "material") return this.choice(this.materials(path), path, id, (name) => this.source(this.about.materials, name), this.constants(path));
    if (key === "standard") return this.choice(["", ...this.about.standards.map((one) => one.name)], path, id, (name) => this.source(this.about.standards, name));
    if (found.enum) return this.choice(found.enum, path, id);
    if (found.type === "boolean") return this.checkbox(path, id);
    if (found.type === "number" || found.type === "integer") return this.number(found, path, id);
    if (found.prefixItems) return this.pair(found, path, id);
    if (found.items && found.items.enum) return this.several(found, path);
    return this.text(found, path, id);
  }

  choice(options, path, id, about, below) {
    const select = element("select", { id, onchange: () => this.set(path, select.value === "" ? null : typeof options[0] === "number" ? Number(select.value) : select.value) });
    const show = (value) => {
      const names = [...options];
      if (value !== undefined && value !== null && !names.includes(value)) names.push(value);
      if (select.options.length !== names.length) {
        select.replaceChildren(...names.map((one) => element("option", { value: String(one) }, one === "" ? "not stated" : String(one))));
      }
      select.value = value === null || value === undefined ? "" : String(value);
    };
    return { single: true, parts: [select], below, show, about: about && (() => about(select.value)) };
  }

  materials(path) {
    const film = path.includes("film"), fits = (one) => (one.is === "piezoelectric-film") === film;
    return this.about.materials.filter(fits).map((one) => one.name);
  }

  source(list, name) {
    const one = list.find((each) => each.name === name);
    return one ? `${one.is}; source: ${one.source} (confidence ${one.confidence})` : "";
  }

  // The constants of the material that a layer has; a change makes it an own material of that name.
  constants(path) {
    const content = element("div"), summary = element("summary", {}, "Its constants");
    const models = Object.values(this.about.schema.$defs).filter((one) => one.properties && one.properties.model);
    let shown = null;
    this.follow(content, () => {
      const name = at(this.values, path), material = name && at(this.values, ["materials", name]);
      const now = material ? name + material.model : null;
      if (now === shown) return;
      shown = now;
      const kind = material && models.find((one) => (one.properties.model.const || one.properties.model.default) === material.model);
      const fields = Object.entries(kind ? kind.properties : {}).filter(([key]) => !["model", "source", "confidence"].includes(key));
      summary.textContent = name ? `Constants of ${name}` : "Its constants";
      content.replaceChildren(...fields.map(([key, schema]) => this.field(schema, ["materials", name, key])));
    });
    return [element("details", {}, summary, content)];
  }

  checkbox(path, id) {
    const box = element("input", { type: "checkbox", id, onchange: () => this.set(path, box.checked) });
    return { single: true, parts: [box], show: (value) => { box.checked = Boolean(value); } };
  }

  number(found, path, id) {
    const whole = found.type === "integer", input = element("input", { type: "text", inputmode: whole ? "numeric" : "decimal", class: "number", id, placeholder: found.optional ? "none" : "" });
    const slider = element("input", { type: "range", min: 0, max: 1000, step: 5, "aria-label": `${dotted(path)}, slider` });
    let scale = null, held = false, waiting = null;
    const send = (value, joined) => this.set(path, value, joined);
    const typed = typing(input, () => send(numberOf(input.value), false));
    slider.addEventListener("input", () => {
      const value = scale.value(Number(slider.value));
      input.value = value;
      slider.setAttribute("aria-valuetext", short(value));
      if (!held) send(value, false);
      else if (waiting === null) waiting = requestAnimationFrame(() => { waiting = null; send(Number(input.value), true); });
      held = true;
    });
    slider.addEventListener("change", () => { held = false; });
    const show = (value) => {
      const stated = value !== null && value !== undefined;
      slider.hidden = !stated || typeof value !== "number";
      if (held) return;
      if (!typed()) input.value = stated ? value : "";
      if (slider.hidden) return;
      if (!scale || value < scale.low || value > scale.high) scale = scaled(found, value, whole);
      slider.value = scale.place(value);
      slider.setAttribute("aria-valuetext", short(value));
    };
    return { single: true, parts: [input], below: [slider], show };
  }

  pair(found, path, id) {
    const inputs = found.prefixItems.map((one, i) => {
      const names = one.enum;
      const made = names ? element("select", {}, ...names.map((each) => element("option", { value: each }, each))) : element("input", { type: "text", inputmode: "decimal", class: "number" });
      made.setAttribute("aria-label", `${dotted(path)} ${"xyz"[i] || i + 1}`);
      made.addEventListener("change", () => this.set(path, inputs.map((each) => (names ? each.value : numberOf(each.value)))));
      return made;
    });
    inputs[0].id = id;
    const show = (value) => inputs.forEach((one, i) => { if (value && document.activeElement !== one) one.value = value[i]; });
    return { single: false, parts: inputs, show };
  }

  several(found, path) {
    const boxes = found.items.enum.map((name) => element("input", { type: "checkbox", value: name, onchange: () => this.set(path, boxes.filter((one) => one.checked).map((one) => one.value)) }));
    const labels = boxes.map((box) => element("label", {}, box, box.value));
    const show = (value) => boxes.forEach((box) => { box.checked = (value || []).includes(box.value); });
    return { single: false, parts: [element("span", { class: "checks" }, ...labels)], show };
  }

  // Texts, and lists of numbers as JSON writes them.
  text(found, path, id) {
    const listed = found.type === "array", input = element("input", { type: "text", id });
    const typed = typing(input, () => {
      let value = input.value === "" ? null : input.value;
      if (listed && value !== null) {
        try { value = JSON.parse(/^\s*\[/.test(value) ? value : `[${value}]`); } catch { /* the program says what is wrong */ }
      }
      this.set(path, value);
    });
    const show = (value) => { if (!typed()) input.value = value === null || value === undefined ? "" : listed ? JSON.stringify(value) : value; };
    return { single: true, parts: [input], show };
  }

  // Physics beyond the baseline: a switch each, and its numbers where it is on.
  mechanisms() {
    return this.about.mechanisms.map((kind) => {
      const content = element("div"), box = element("input", { type: "checkbox" });
      const mine = () => (this.values.mechanisms || []).flatMap((one, i) => (one.name === kind.name ? [i] : []));
      const add = (component) => this.set(["mechanisms", (this.values.mechanisms || []).length], { name: kind.name, component, parameters: kind.example });
      box.addEventListener("change", () => {
        if (box.checked) add(kind.components.includes("medium2") ? "medium2" : kind.components[0]);
        else this.ask({ do: "change", changes: mine().reverse().map((i) => [["mechanisms", i], null]) });
      });
      let shown = null;
      this.follow(content, () => {
        const places = mine(), now = places.join();
        box.checked = places.length > 0;
        if (now === shown) return;
        shown = now;
        content.replaceChildren(...places.flatMap((i) => this.mechanism(kind, i)));
      });
      return element("div", { class: "field" }, element("label", { class: "switch" }, box, kind.name.replaceAll("-", " ")), element("p", { class: "about" }, kind.about), content);
    });
  }

  mechanism(kind, i) {
    const where = { enum: kind.components, description: "where it acts" };
    const fields = Object.entries(kind.schema.properties || {}).map(([name, schema]) => {
      const typical = kind.typical[name] ? `; typical: ${kind.typical[name]}` : "";
      return this.field({ ...schema, description: (schema.description || "") + typical }, ["mechanisms", i, "parameters", name]);
    });
    return [element("div", { class: "items" }, this.field(where, ["mechanisms", i, "component"]), ...fields)];
  }
}

// Calls done when a field has been filled; returns whether somebody is typing in it, so that it is left alone.
function typing(input, done) {
  let busy = false;
  input.addEventListener("input", () => { busy = true; });
  input.addEventListener("change", () => { busy = false; done(); });
  return () => busy && document.activeElement === input;
}

// From a place between 0 and 1000 on a slider to a value and back; sizes are spaced by their ratios.
function scaled(found, value, whole) {
  const low = found.minimum ?? found.exclusiveMinimum, high = found.maximum ?? found.exclusiveMaximum;
  const rounded = (one) => (whole ? Math.round(one) : Number(one.toPrecision(3)));
  const bounded = low !== undefined && high !== undefined && high - low <= 100;
  if (!bounded && low !== undefined && low >= 0 && value > 0) {
    const [a, b] = [Math.max(value / 8, whole ? 1 : 0), Math.min(value * 8, high ?? Infinity)];
    return { low: a, high: b, value: (place) => rounded(a * (b / a) ** (place / 1000)), place: (one) => (1000 * Math.log(one / a)) / Math.log(b / a) };
  }
  const reach = Math.max(2 * Math.abs(value), 1);
  const [a, b] = bounded ? [low, high] : [Math.max(-reach, low ?? -Infinity), Math.min(reach, high ?? Infinity)];
  const inner = bounded && found.exclusiveMinimum !== undefined ? a + (b - a) / 1000 : a;
  return { low: a, high: b, value: (place) => rounded(inner + ((b - inner) * place) / 1000), place: (one) => (1000 * (one - inner)) / (b - inner) };
}

// Whether a word occurs in a field or in the title of a group that holds it.
function found(field, wanted) {
  if (field.textContent.toLowerCase().includes(wanted)) return true;
  for (let group = field.closest("details"); group; group = group.parentElement.closest("details")) {
    if (group.querySelector("summary").textContent.toLowerCase().includes(wanted)) return true;
  }
  return false;
}

// Hide what a word does not occur in; what is found is opened.
export function filter(root, word) {
  const wanted = word.trim().toLowerCase();
  for (const field of root.querySelectorAll(".field")) field.hidden = wanted !== "" && !found(field, wanted) && !field.querySelector(".field:not([hidden])");
  for (const group of [...root.querySelectorAll("details")].reverse()) {
    if (group.wasOpen === undefined) group.wasOpen = group.open;
    const some = group.querySelector(".field:not([hidden])");
    group.hidden = wanted !== "" && !some;
    group.open = wanted === "" ? group.wasOpen : Boolean(some);
    if (wanted === "") delete group.wasOpen;
  }
}

// The field of the key with which a sentence begins, null where there is none.
export function named(root, sentence) {
  const key = sentence.split(/[ :]/, 1)[0];
  return [...root.querySelectorAll(".field[data-key]")].find((one) => one.dataset.key === key) || null;
}

// Open what hides a field and go there.
export function go(field) {
  const search = document.querySelector("#find");
  search.value = "";
  search.dispatchEvent(new Event("input"));
  for (let group = field.closest("details"); group; group = group.parentElement.closest("details")) group.open = true;
  field.scrollIntoView({ block: "center" });
  field.querySelector("input, select").focus();
}
