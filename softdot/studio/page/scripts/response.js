// Voltage, force and charge against one number of the design: full presses on the line of the estimate.
import { element, node, short, ticks } from "./dom.js";
import { numberOf, quantity } from "./numbers.js";
import { GIVEN, given } from "./quantities.js";
import { Heard } from "./sound.js";

const WIDTH = 330,
  HEIGHT = 220,
  [LEFT, RIGHT, TOP, BOTTOM] = [50, WIDTH - 10, 24, HEIGHT - 36],
  SIZE = 4;

// From values to places, with room at the ends.
function scale(values, from, to, room) {
  const [low, high] = [Math.min(...values), Math.max(...values)],
    more = room * (high - low || Math.abs(high) || 1);
  const [first, last] = [low - more, high + more];
  return { first, last, at: (value) => from + ((value - first) / (last - first)) * (to - from) };
}

function axes(chart, X, Y, across, title) {
  chart.append(node("text", { x: 6, y: 14, class: "title" }, title));
  for (const value of ticks(Y.first, Y.last, 4)) {
    chart.append(node("line", { class: "grid", x1: LEFT, x2: RIGHT, y1: Y.at(value), y2: Y.at(value) }));
    chart.append(node("text", { x: LEFT - 5, y: Y.at(value) + 4, "text-anchor": "end" }, short(value)));
  }
  for (const value of ticks(X.first, X.last, 4))
    chart.append(node("text", { x: X.at(value), y: BOTTOM + 14, "text-anchor": "middle" }, short(value)));
  chart.append(node("text", { x: (LEFT + RIGHT) / 2, y: HEIGHT - 4, "text-anchor": "middle" }, across));
}

// The estimate with the band of its error.
function estimated(chart, X, Y, line, key) {
  const places = (sign) => line.map((one) => `${X.at(one.value)} ${Y.at(one[key].value + sign * one[key].error)}`);
  const upper = places(1),
    lower = places(-1).reverse();
  chart.append(
    node("path", { class: "band estimate", d: `M${[...upper, ...lower].join("L")}Z` }),
    node("path", { class: "line estimate", d: `M${places(0).join("L")}` }),
  );
}

function point(chart, X, Y, one, { key, unit }) {
  const x = X.at(one.value);
  if (one.said) {
    const cross = node("path", { class: "failed", d: `M${x - 4} ${BOTTOM - 8}l8 8m0 -8l-8 8` });
    cross.append(node("title", {}, `${short(one.value)}: ${one.said}`));
    return chart.append(cross);
  }
  const warned = one.warnings.length > 0,
    dot = node("circle", { class: warned ? "point warned" : "point", cx: x, cy: Y.at(one[key]), r: SIZE });
  dot.append(node("title", {}, [`${short(one.value)}: ${quantity(one[key], unit)}`, ...one.warnings].join("; ")));
  return chart.append(dot);
}

const titled = ({ name, unit }) => (unit ? `${name} (${unit})` : name);

// What the program has found of a number of the form; what: quantity that is drawn.
function drawn({ points, line, range }, number, what) {
  const chart = node("svg", { class: "chart", viewBox: `0 0 ${WIDTH} ${HEIGHT}`, "aria-hidden": "true" });
  const good = points.filter((one) => !one.said),
    ends = line.flatMap((one) => [1, -1].map((sign) => one[what.key].value + sign * one[what.key].error));
  const heights = [...good.map((one) => one[what.key]), ...ends];
  const X = scale(range, LEFT, RIGHT, 0.04),
    Y = scale(heights.length ? heights : [0, 1], BOTTOM, TOP, 0.08);
  axes(chart, X, Y, titled(number), `${what.name} (${what.unit})`);
  const { now } = number;
  if (now >= range[0] && now <= range[1])
    chart.append(node("line", { class: "now", x1: X.at(now), x2: X.at(now), y1: TOP, y2: BOTTOM }));
  if (line.length > 1) estimated(chart, X, Y, line, what.key);
  for (const one of points) point(chart, X, Y, one, what);
  return chart;
}

const LINES = {
  family: "The line is the family's answer, the band its interval.",
  derivatives: "The line is an estimate to first order from the press of this design, the band its error.",
};

export class ResponsePanel {
  // form: where a number is chosen; place: where the answer stands; ask(message): tells the program; say(text): aloud.
  constructor(form, place, ask, say) {
    this.form = form;
    this.place = place;
    this.ask = ask;
    this.numbers = [];
    this.found = null;
    this.what = GIVEN[0].key;
    this.isChosen = false;
    this.find = (selector) => form.querySelector(selector);
    this.find(".key").addEventListener("change", () => {
      this.isChosen = true;
    });
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      const chosen = this.numbers.find((one) => one.key === this.find(".key").value);
      if (chosen) this.start(chosen.path, numberOf(this.find(".low").value), numberOf(this.find(".high").value));
    });
    this.build(say);
  }

  // What stays while points come: the choice, the chart with its keys and sound, words, table.
  build(say) {
    this.chart = element("div", { class: "chart", tabindex: 0, role: "img" });
    this.words = element("div", {});
    const region = { class: "wide", tabindex: 0, role: "region", "aria-label": "Presses along one number" };
    this.rows = element("div", region);
    const select = element("select", {}, ...GIVEN.map(({ key, name }) => element("option", { value: key }, name)));
    select.addEventListener("change", () => {
      this.what = select.value;
      this.draw();
    });
    const about = { type: "button", "aria-label": "Hear it", title: "Pitch is its height; arrow keys go along it" };
    this.parts = [
      element("div", { class: "row" }, element("label", {}, "Show ", select), element("button", about, "♪")),
      element("div", {}, this.chart),
      this.words,
      element("details", {}, element("summary", {}, "As a table"), this.rows),
    ];
    this.heard = new Heard(this.chart, () => this.series(), { title: "", x: "", y: "" }, say);
    this.parts[0].querySelector("button").addEventListener("click", () => this.heard.whole());
  }

  start(key, low, high) {
    this.ask({ do: "start", task: "response", key, low, high });
  }

  // The same presses, of the design as it is now.
  again() {
    this.start(this.found.path, ...this.found.range);
  }

  // Numbers of the form; before one is chosen, the list follows the hand.
  offer(numbers) {
    const select = this.find(".key"),
      before = select.value,
      keys = (all) => all.join();
    this.numbers = numbers;
    if (keys([...select.options].map((one) => one.value)) !== keys(numbers.map((one) => one.key)))
      select.replaceChildren(...numbers.map((one) => element("option", { value: one.key }, titled(one))));
    if (numbers.some((one) => one.key === before)) select.value = before;
    if (this.found) this.draw();
  }

  follow(key) {
    if (!this.isChosen && this.numbers.some((one) => one.key === key)) this.find(".key").value = key;
  }

  show(found) {
    if (!this.found) this.place.append(...this.parts);
    this.found = found;
    this.draw();
  }

  // The number that was followed, as the form names it.
  get number() {
    const { key } = this.found;
    return this.numbers.find((one) => one.key === key) || { key, name: key, unit: "", now: NaN };
  }

  // What is heard: the presses, then the estimate.
  series() {
    if (!this.found) return [];
    const good = this.found.points.filter((one) => !one.said),
      { line } = this.found,
      values = (all) => all.map((one) => one.value);
    const all = [
      { name: "full presses", x: values(good), y: good.map((one) => one[this.what]) },
      { name: "estimate", x: values(line), y: line.map((one) => one[this.what].value) },
    ];
    return all.filter((one) => one.x.length);
  }

  draw() {
    const { found, number } = this,
      what = given(this.what);
    this.chart.replaceChildren(drawn(found, number, what));
    const [x, y] = [titled(number), `${what.name} (${what.unit})`];
    this.heard.axes = { title: what.name, x, y };
    this.chart.setAttribute("aria-label", `${y} against ${x}; arrow keys go along it, Enter plays it`);
    const missing = found.count - found.points.length,
      more = missing ? ` ${missing} of ${found.count} are not pressed.` : "";
    const hollow = found.points.some((one) => !one.said && one.warnings.length) ? " Hollow: with a warning." : "";
    const words = found.line.length > 1 ? LINES[found.by] : "Beside these values nothing is estimated.";
    this.words.replaceChildren(
      element("p", { class: "soft" }, `Points are full presses, on the mesh of the design.${hollow}${more} ${words}`),
      ...found.points
        .filter((one) => one.said)
        .map((one) => element("p", {}, `${short(one.value)} ${number.unit}: ${one.said}`)),
    );
    this.rows.replaceChildren(this.table(titled(number)));
  }

  table(name) {
    const head = [name, ...GIVEN.map((one) => `${one.name} (${one.unit})`), ""];
    const row = (one) =>
      element(
        "tr",
        {},
        element("th", { scope: "row" }, short(one.value)),
        ...GIVEN.map(({ key }) => element("td", {}, one.said ? "–" : short(one[key]))),
        element("td", {}, this.use(one)),
      );
    return element(
      "table",
      {},
      element("thead", {}, element("tr", {}, ...head.map((one) => element("th", { scope: "col" }, one)))),
      element("tbody", {}, ...this.found.points.map(row)),
    );
  }

  use({ value }) {
    const set = () => this.ask({ do: "set", key: this.found.path, value });
    return element("button", { type: "button", "aria-label": `Use ${short(value)}`, onclick: set }, "Use");
  }
}
