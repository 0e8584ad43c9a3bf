// An array: the dots of a cell as buttons, and the voltages of all segments on a view from above.
import { segments } from "./charts.js";
import { element, find, findAll, short } from "./dom.js";

const FIRST = 0x2800,
  COLUMNS = [
    [1, 4],
    [2, 5],
    [3, 6],
  ];
const LATE_MS = 3000;
let pressed = null,
  layout = null,
  hash = null,
  wanted = null;

const bits = () => (layout && layout.cell ? layout.cell.codePointAt(0) - FIRST : 0);
const raised = (dot) => Boolean((bits() >> (dot - 1)) & 1);
const name = (label) => label.replace("segment-", "");

// The cell of a design and its pressed dot are one change: the dot must be one that is raised.
function toggle(dot, ask) {
  const next = bits() ^ (1 << (dot - 1));
  layout.cell = next ? String.fromCodePoint(FIRST + next) : null;
  wanted = { cell: layout.cell, at: performance.now() };
  const first = [1, 2, 3, 4, 5, 6].find((one) => (next >> (one - 1)) & 1) || 1;
  ask({
    do: "change",
    changes: [
      [["dot", "cell"], layout.cell],
      [["dot", "cell_dot"], first > 1 ? first : null],
    ],
  });
  hash = undefined; // the voltages are those of the cell before
  drawCell();
  draw();
}

export function prepare(ask) {
  const rows = COLUMNS.map((row) =>
    row.map((dot) =>
      element(
        "button",
        { type: "button", "data-dot": dot, "aria-pressed": "false", onclick: () => toggle(dot, ask) },
        `Dot ${dot}`,
      ),
    ),
  );
  find("#array .cell").replaceChildren(...rows.flat());
}

// values: of the design; told: what its check says, which has no array where there is a mistake.
export function state(told) {
  if (!told.values) return !find("#array").hidden;
  const there = Boolean(told.values.array);
  find("#array").hidden = !there;
  find("#result").classList.toggle("of-array", there);
  for (const one of findAll(".alone")) one.hidden = there;
  if (!there || !told.array) return there;
  const late = wanted && wanted.cell !== told.array.cell && performance.now() - wanted.at < LATE_MS;
  if (!late) wanted = null;
  layout = late ? { ...told.array, cell: wanted.cell } : told.array; // an answer to a click before the last one
  hash = told.press_hash;
  drawCell();
  draw();
  return there;
}

function drawCell() {
  for (const button of find("#array .cell").children) {
    const dot = Number(button.dataset.dot),
      under = layout.under[dot];
    button.setAttribute("aria-pressed", String(raised(dot)));
    button.disabled = under === undefined;
    button.title =
      under === undefined ? "no segment lies under it" : `over segment ${name(layout.labels[under])}`;
  }
  find("#array .which").textContent = layout.cell
    ? `The cell ${layout.cell}`
    : "No dot is raised: raise one to press it.";
}

export function show(numbers) {
  pressed = numbers;
  draw();
}

function draw() {
  if (!layout) return;
  const now =
    pressed && pressed.press_hash === hash && pressed.voltage_V.length === layout.labels.length
      ? pressed
      : null;
  const places = layout.labels.map((label, i) => ({
    label: name(label),
    at: layout.centres_mm[i],
    volts: now ? now.voltage_V[i] : null,
  }));
  const dots = Object.entries(layout.under)
    .filter(([dot]) => raised(Number(dot)))
    .map(([, number]) => layout.centres_mm[number]);
  find("#array .map").replaceChildren(segments({ places, dots, size: layout.size_mm, half: layout.half_mm }));
  const what = now && now.amplified ? "at the amplifiers" : "at open circuit";
  find("#array figcaption").textContent = now
    ? `Voltages ${what}, ${short(now.depth_mm)} mm deep with ${short(now.force_N)} N; rings are the raised dots. ` +
      `On large elements, some percent off.${now.failure ? ` Not converged: ${now.failure}.` : ""}`
    : "The array from above; rings are the raised dots. The voltages follow the press.";
}
