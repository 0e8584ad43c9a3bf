// Elements in one call, and numbers as people read them.

/**
 * An element of the page. attributes: those that begin with "on" are listeners.
 * @param {string} tag
 * @param {Record<string, any>} attributes
 * @param {...(Node | string | null | undefined)} children
 * @returns {any}
 */
export function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else if (name === "value" || name === "checked" || name === "disabled") made[name] = value;
    else made.setAttribute(name, value === true ? "" : value);
  }
  made.append(...children.filter((child) => child !== null && child !== undefined));
  return made;
}

/** @type {(selector: string) => any} */
export const find = (selector) => document.querySelector(selector);

/** @type {(selector: string) => any[]} */
export const findAll = (selector) => [...document.querySelectorAll(selector)];

export function short(value) {
  if (value === null || value === undefined) return "–";
  if (typeof value !== "number") return typeof value === "string" ? value : JSON.stringify(value);
  if (value !== 0 && (Math.abs(value) >= 1e5 || Math.abs(value) < 1e-3)) return value.toExponential(2);
  return String(Number(value.toPrecision(4)));
}

export function duration(seconds) {
  return seconds < 90
    ? Math.max(1, Math.round(seconds)) + "\u00a0s"
    : (seconds / 60).toFixed(1) + "\u00a0min";
}

// A dotted key, which a narrow column may break between its words.
export function breakable(key) {
  return key.split(/(?<=[._])/).flatMap((part, i) => (i ? [element("wbr"), part] : [part]));
}

// "thickness_mm" -> ["thickness", "mm"]; the endings come from the program.
export function worded(key, units) {
  for (const [ending, unit] of Object.entries(units)) {
    if (key.endsWith(ending)) return [key.slice(0, -ending.length).replaceAll("_", " "), unit];
  }
  return [key.replaceAll("_", " "), ""];
}

// An element of a picture as SVG.
export function node(tag, attributes, text) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  if (text !== undefined) made.textContent = text;
  return made;
}

// Round numbers between two ends, about as many as count.
export function ticks(low, high, count) {
  const rough = (high - low) / count,
    power = 10 ** Math.floor(Math.log10(rough)),
    found = [];
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((one) => one >= rough * (1 - 1e-9));
  for (let at = Math.ceil(low / step - 1e-9) * step; at <= high + 1e-9 * step; at += step) {
    found.push(Math.abs(at) < 1e-9 * step ? 0 : at);
  }
  return found;
}

// What is made is offered as a file.
export function download(content, name) {
  const made = URL.createObjectURL(content);
  element("a", { href: made, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(made), 1000);
}

// A toolbar is one stop of the tab key; the arrow keys go along it (ARIA Authoring Practices, toolbar).
export function roving(toolbar) {
  const buttons = () => [...toolbar.querySelectorAll("button")].filter((one) => !one.disabled);
  const settle = (at) => {
    for (const one of toolbar.querySelectorAll("button")) one.tabIndex = one === at ? 0 : -1;
  };
  toolbar.addEventListener("focusin", (event) => settle(event.target));
  toolbar.addEventListener("keydown", (event) => {
    const way = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key], all = buttons();
    if (!way) return;
    all[(all.indexOf(document.activeElement) + way + all.length) % all.length].focus();
    event.preventDefault();
  });
  settle(buttons()[0]);
}
