// A sensor cut through the middle, to scale but for the film, which would be too thin to see.
import { node } from "./dom.js";

const COLOURS = {
  effector: "#e3b064",
  medium1: "#7fbf9c",
  film: "#b3263f",
  medium2: "#9ab6d6",
  dot: "#8b919b",
};
const ROOM = { width: 200, height: 110 },
  FILM_PX = 3;

function effector({ shape, width, height }, middle, top, scale) {
  const wide = width * scale,
    tall = height * scale,
    left = middle - wide / 2;
  if (shape !== "dome")
    return node("rect", { x: left, y: top - tall, width: wide, height: tall, fill: COLOURS.effector });
  return node("path", {
    d: `M${left} ${top}Q${middle} ${top - 2 * tall} ${left + wide} ${top}Z`,
    fill: COLOURS.effector,
  });
}

// sizes: {length, medium1, medium2, effector: {shape, width, height} or null, columns}, in mm; null where not known.
export function sketch(sizes, { width, height } = ROOM) {
  const svg = node("svg", { viewBox: `0 0 ${width} ${height}`, class: "sketch", "aria-hidden": "true" });
  if (!sizes) return svg;
  const { length, medium1, medium2, effector: top, columns = 1 } = sizes,
    gap = 0.08 * length;
  const whole = columns * length + (columns - 1) * gap,
    dot = 0.25 * length;
  const tall = medium1 + medium2 + (top ? top.height : 0) + dot;
  const scale = Math.min((0.94 * width) / whole, (0.94 * height - FILM_PX) / tall);
  const first = (width - whole * scale) / 2,
    floor = height - 3;
  for (let k = 0; k < columns; k++) {
    const left = first + k * (length + gap) * scale,
      middle = left + (length * scale) / 2;
    const film = floor - medium2 * scale - FILM_PX,
      upper = film - medium1 * scale;
    const layer = (y, high, name) =>
      svg.append(node("rect", { x: left, y, width: length * scale, height: high, fill: COLOURS[name] }));
    layer(film + FILM_PX, medium2 * scale, "medium2");
    layer(film, FILM_PX, "film");
    layer(upper, medium1 * scale, "medium1");
    if (top) svg.append(effector(top, middle, upper, scale));
    const head = upper - (top ? top.height * scale : 0),
      radius = 0.22 * length * scale,
      crown = head - dot * scale;
    svg.append(
      node("path", {
        d: `M${middle - radius} ${crown}A${radius} ${0.95 * dot * scale} 0 0 0 ${middle + radius} ${crown}Z`,
        fill: COLOURS.dot,
      }),
    );
  }
  return svg;
}

/** @type {[string, string, number][]} */
const LABELS = [
  ["dot", "the Braille dot, a rigid cap", 30],
  ["effector", "effector: passes the dot's force on", 64],
  ["medium1", "medium 1: soft", 104],
  ["film", "PVDF film, 28 µm: strain becomes charge", 132],
  ["medium2", "medium 2: carries the film", 182],
];

// The sensor with its parts named.
export function labelled() {
  const svg = node("svg", { viewBox: "0 0 420 236", class: "sketch", role: "img" });
  svg.append(
    node(
      "title",
      {},
      `A sensor cut through the middle, from above: ${LABELS.map(([, words]) => words).join("; ")}.`,
    ),
  );
  const parts = [
    ["medium2", 138, 84],
    ["film", 132, 6],
    ["medium1", 98, 34],
    ["effector", 48, 50],
  ];
  for (const [name, y, high] of parts)
    svg.append(node("rect", { x: 14, y, width: 130, height: high, fill: COLOURS[name] }));
  svg.append(node("path", { d: "M47 12H111V38A32 30 0 0 1 47 38Z", fill: COLOURS.dot }));
  svg.append(
    node("path", {
      d: "M79 0V10M74 5L79 12L84 5",
      stroke: "currentColor",
      fill: "none",
      "stroke-width": 1.5,
    }),
  );
  for (const [name, words, y] of LABELS) {
    const from = name === "dot" ? 108 : 144;
    svg.append(
      node("path", { d: `M${from} ${y}H164`, class: "lead" }),
      node("text", { x: 168, y: y + 4 }, words),
    );
  }
  svg.append(
    node("path", { d: "M14 232H144M14 227V236M144 227V236", class: "lead" }),
    node("text", { x: 168, y: 234 }, "2.5 mm"),
  );
  return svg;
}
