// The form, made from the schema of the configuration: a new key appears by itself.
import { control } from "./controls.js";
import { element, short, worded } from "./dom.js";

const OPEN = ["segment", "effector", "medium1", "film", "medium2", "press", "dot"];
const NAMES = { medium1: "Medium 1", medium2: "Medium 2", readout: "Amplifier" };
const at = (values, path) =>
  path.reduce((found, part) => (found === null || found === undefined ? undefined : found[part]), values);
const dotted = (path) =>
  path
    .map((part) => (typeof part === "number" ? `[${part}]` : "." + part))
    .join("")
    .slice(1);
const titled = (name) => NAMES[name] || (name[0].toUpperCase() + name.slice(1)).replaceAll("_", " ");
const of = (sentence, key) => sentence.startsWith(key) && !/[\w.]/.test(sentence[key.length] || " ");
let count = 0;

// What a person calls a key: "thickness of medium 1".
function spoken(words, path) {
  const table = path
    .slice(0, -1)
    .filter((one) => typeof one === "string" && one !== "segment" && one !== "parameters")
    .pop();
  return table ? `${words} of ${titled(table).toLowerCase()}` : words;
}

export class Form {
  // about: what the program says of its configuration; ask(message): tells the program.
  constructor(about, ask) {
    this.about = about;
    this.ask = ask;
    this.updaters = new Set();
    this.values = {};
    this.stated = {};
    this.mistakes = [];
    this.remedies = [];
    this.good = null;
  }

  resolved(schema) {
    const named = (one) =>
      one.$ref
        ? { ...this.about.schema.$defs[one.$ref.split("/").pop()], description: one.description }
        : one;
    const some = (schema.anyOf || [schema]).filter((one) => one.type !== "null"),
      actsWith = schema["x-acts-with"] || [];
    return {
      ...named(some[0]),
      description: schema.description,
      optional: Boolean(schema.anyOf),
      default: schema.default,
      actsWith,
    };
  }

  // Whether a key acts beside the values of its table: of each condition one tag has one of its values, or is there.
  acts(found, path) {
    const table = at(this.values, path.slice(0, -1)) || {};
    const has = (value, wanted) =>
      Array.isArray(wanted)
        ? wanted.includes(value)
        : (value !== undefined && value !== null) === (wanted === "stated");
    return found.actsWith.every((tags) =>
      Object.entries(tags).some(([key, wanted]) => has(table[key], wanted)),
    );
  }

  // Whether a key is shown before somebody asks for all: a template states it, the design does, or it is in a list.
  isBasic(path) {
    const key = dotted(path),
      inside = (one) => one === key || one.startsWith(key + ".");
    return (
      path.some((part) => typeof part === "number") ||
      at(this.stated, path) !== undefined ||
      this.about.basic.some(inside)
    );
  }

  update(values, stated, mistakes, remedies = []) {
    if (values) this.values = values;
    if (stated) this.stated = stated;
    this.mistakes = mistakes;
    this.remedies = remedies;
    if (values && !mistakes.length) this.good = { values, stated };
    for (const updater of [...this.updaters]) updater();
  }

  // Runs now and at every update, as long as its element is in the page.
  follow(anchor, updater) {
    const guarded = () =>
      anchor.isConnected || !anchor.wasConnected ? updater() : this.updaters.delete(guarded);
    this.updaters.add(() => {
      if (anchor.isConnected) anchor.wasConnected = true;
      guarded();
    });
    updater();
  }

  whole() {
    const groups = [];
    for (const [name, schema] of Object.entries(this.about.schema.properties)) {
      if (name === "materials") continue;
      if (name === "mechanisms")
        groups.push(this.group("Mechanisms", schema.description, this.mechanisms(), false));
      else if (name === "seed") groups.push(this.field(schema, [name]));
      else groups.push(this.table(schema, [name]));
    }
    return groups;
  }

  group(title, about, content, open) {
    return element("details", { open, title: about }, element("summary", {}, title), ...content);
  }

  // A table of the configuration: its values, then its tables. One that may be left out has a switch.
  table(schema, path) {
    const found = this.resolved(schema),
      name = String(path[path.length - 1]),
      content = element("div");
    const rebuild = () => content.replaceChildren(...(at(this.values, path) ? this.rows(found, path) : []));
    const parts = [content];
    if (found.optional) {
      const box = element("input", {
        type: "checkbox",
        onchange: () => this.set(path, box.checked ? {} : null),
      });
      const field = element(
        "div",
        { class: "field" },
        element(
          "label",
          { class: "switch" },
          element("span", { class: "name" }, `with ${titled(name).toLowerCase()}`),
          box,
        ),
      );
      field.dataset.about = found.description || "";
      parts.unshift(field);
      let shown = null;
      this.follow(content, () => {
        const there = Boolean(at(this.values, path));
        box.checked = there;
        field.classList.toggle("extra", !there && !this.isBasic(path));
        if (there !== shown) rebuild();
        shown = there;
      });
    } else content.replaceChildren(...this.rows(found, path));
    return this.group(titled(name), found.description, parts, OPEN.includes(name));
  }

  rows(found, path) {
    const plain = [],
      tables = [];
    for (const [name, schema] of Object.entries(found.properties)) {
      const inner = this.resolved(schema),
        way = [...path, name];
      if (inner.properties) tables.push(this.table(schema, way));
      else if (inner.type === "array" && inner.items && inner.items.$ref) tables.push(this.list(inner, way));
      else if (inner.type !== "object") plain.push(this.field(schema, way));
    }
    return [...plain, ...tables];
  }

  // Tables that may be repeated.
  list(found, path) {
    const content = element("div", { class: "field" });
    const kind = this.resolved(found.items),
      name = titled(String(path[path.length - 1]));
    let length = null;
    this.follow(content, () => {
      const items = at(this.values, path) || [];
      content.classList.toggle("extra", !items.length && !this.isBasic(path));
      if (items.length === length) return;
      length = items.length;
      const remove = (i) =>
        element(
          "button",
          { type: "button", onclick: () => this.set([...path, i], null) },
          `Remove ${name.toLowerCase()} ${i + 1}`,
        );
      const blocks = items.map((_, i) =>
        element("div", { class: "items" }, ...this.rows(kind, [...path, i]), remove(i)),
      );
      const add = () => this.set([...path, items.length], this.starting(kind));
      content.replaceChildren(
        ...blocks,
        element("button", { type: "button", onclick: add }, `Add ${name.toLowerCase()}`),
      );
    });
    return this.group(name, found.description, [content], false);
  }

  starting(kind) {
    const found = {};
    for (const [name, schema] of Object.entries(kind.properties)) {
      if (!(kind.required || []).includes(name)) continue;
      const one = this.resolved(schema),
        positive = (part) => ("exclusiveMinimum" in part ? 1 : 0);
      if (one.prefixItems)
        found[name] = one.prefixItems.map((part, i) => (part.enum ? part.enum[i] : positive(part)));
      else
        found[name] = one.enum ? one.enum[0] : one.type === "string" ? "one" : one.type === "array" ? [] : 1;
    }
    return found;
  }

  set(path, value, joined = false) {
    this.ask({ do: "set", key: path, value, joined });
  }

  // One key in one line: its name, control and unit. What it means stands below the form, and is read aloud.
  field(schema, path) {
    const found = this.resolved(schema),
      key = String(path[path.length - 1]),
      id = `field-${++count}`;
    const [words, unit] = worded(key, this.about.units),
      made = control(this, found, path, id, spoken(words, path));
    if (made.slider) made.slider.dataset.unit = unit;
    const hint = element("span", { class: "aside", id: `${id}-about` }, found.description || "");
    const wrong = element("div", { class: "wrong", id: `${id}-wrong` });
    const name = element("span", { class: "name" }, words),
      units = element("span", { class: "unit" }, unit);
    const parts = [
      name,
      ...(made.slider ? [made.slider] : []),
      element("span", { class: "control" }, ...made.parts, units),
    ];
    const head = made.single
      ? element("label", { for: id }, ...parts)
      : element("div", { class: "label", role: "group", "aria-label": spoken(words, path) }, ...parts);
    const below = key === "material" ? [this.constants(path)] : [];
    const box = element(
      "div",
      { class: made.slider ? "field sliding" : "field" },
      head,
      hint,
      wrong,
      ...below,
    );
    for (const part of made.parts)
      if (part.matches("input, select")) part.setAttribute("aria-describedby", `${hint.id} ${wrong.id}`);
    box.dataset.key = dotted(path);
    this.follow(box, () => {
      const value = at(this.values, path),
        stated = at(this.stated, path) !== undefined;
      made.show(value === undefined ? found.default : value);
      box.classList.toggle("inert", !this.acts(found, path) && !stated);
      box.classList.toggle("extra", !this.isBasic(path));
      box.classList.toggle("stated", stated);
      this.mark(box, wrong, path, made.parts);
      hint.textContent = [found.description, made.about && made.about()].filter(Boolean).join(". ");
      box.dataset.about = hint.textContent;
    });
    return box;
  }

  // A mistake at its field, with what would mend it.
  mark(box, wrong, path, parts) {
    const number = this.mistakes.findIndex((one) => of(one, dotted(path))),
      sentence = this.mistakes[number];
    box.classList.toggle("bad", Boolean(sentence));
    for (const part of parts) part.setAttribute("aria-invalid", String(Boolean(sentence)));
    if (!sentence) return wrong.replaceChildren();
    const before = this.good && at(this.good.values, path),
      remedy = this.remedies[number],
      buttons = [];
    const button = (words, action) =>
      buttons.push(element("button", { type: "button", onclick: action }, words));
    const there =
      before !== undefined &&
      before !== null &&
      JSON.stringify(before) !== JSON.stringify(at(this.values, path));
    if (there) button(`Back to ${short(before)}`, () => this.set(path, at(this.good.stated, path) ?? null));
    if (remedy) button(`Or ${remedy.says}`, () => this.ask({ do: "change", changes: remedy.changes }));
    return wrong.replaceChildren(
      sentence.slice(dotted(path).length).replace(/^ = /, ""),
      element("br"),
      ...buttons,
    );
  }

  // The constants of the material that a layer has; a change makes it an own material of that name.
  constants(path) {
    const content = element("div"),
      summary = element("summary", {}, "Its constants");
    const models = Object.values(this.about.schema.$defs).filter(
      (one) => one.properties && one.properties.model,
    );
    let shown = null;
    this.follow(content, () => {
      const name = at(this.values, path),
        material = name && at(this.values, ["materials", name]);
      const now = material ? name + material.model : null;
      if (now === shown) return;
      shown = now;
      const kind =
        material &&
        models.find((one) => (one.properties.model.const || one.properties.model.default) === material.model);
      const fields = Object.entries(kind ? kind.properties : {}).filter(
        ([key]) => !["model", "source", "confidence"].includes(key),
      );
      summary.textContent = name ? `Constants of ${name}` : "Its constants";
      content.replaceChildren(...fields.map(([key, schema]) => this.field(schema, ["materials", name, key])));
    });
    return element("details", {}, summary, content);
  }

  // Physics beyond the baseline: a switch each, and its numbers where it is on.
  mechanisms() {
    return this.about.mechanisms.map((kind) => {
      const content = element("div"),
        box = element("input", { type: "checkbox" });
      const mine = () =>
        (this.values.mechanisms || []).flatMap((one, i) => (one.name === kind.name ? [i] : []));
      const add = (component) =>
        this.set(["mechanisms", (this.values.mechanisms || []).length], {
          name: kind.name,
          component,
          parameters: kind.example,
        });
      box.addEventListener("change", () => {
        if (box.checked) add(kind.components.includes("medium2") ? "medium2" : kind.components[0]);
        else
          this.ask({
            do: "change",
            changes: mine()
              .reverse()
              .map((i) => [["mechanisms", i], null]),
          });
      });
      const words = element("span", { class: "name" }, kind.name.replaceAll("-", " "));
      const field = element(
        "div",
        { class: "field" },
        element("label", { class: "switch" }, words, box),
        content,
      );
      field.dataset.about = kind.about;
      let shown = null;
      this.follow(content, () => {
        const places = mine(),
          now = places.join();
        box.checked = places.length > 0;
        field.classList.toggle("extra", !places.length);
        if (now === shown) return;
        shown = now;
        content.replaceChildren(...places.flatMap((i) => this.mechanism(kind, i)));
      });
      return field;
    });
  }

  mechanism(kind, i) {
    const where = { enum: kind.components, description: "where it acts" };
    const fields = Object.entries(kind.schema.properties || {}).map(([name, schema]) => {
      const typical = kind.typical[name] ? `; typical: ${kind.typical[name]}` : "";
      return this.field({ ...schema, description: (schema.description || "") + typical }, [
        "mechanisms",
        i,
        "parameters",
        name,
      ]);
    });
    return [element("div", { class: "items" }, this.field(where, ["mechanisms", i, "component"]), ...fields)];
  }
}
