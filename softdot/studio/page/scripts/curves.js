// Force, charge and voltage of the designs and of a recording, over depth or time, with uPlot.
import { download, element, find, findAll, short } from "./dom.js";
import { Heard } from "./sound.js";

const QUANTITIES = [
  { key: "reaction_force_N", title: "Force", unit: "N", error: "force_percent", channel: /^force_N/ },
  { key: "film_charge_pC", title: "Charge", unit: "pC", error: "charge_percent", channel: /^charge_pC/ },
  {
    key: "open_circuit_voltage_V",
    title: "Open circuit",
    unit: "V",
    error: "voltage_percent",
    channel: /^voltage_V/,
  },
];
const sum = (table) =>
  Object.values(table).reduce((whole, one) => one.map((value, i) => value + (whole ? whole[i] : 0)), null);
const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const last = (values) => (values && values.length ? values[values.length - 1] : null);

// Over depth only the way in is drawn, whose depths grow; a press that comes back is whole over time.
function wayIn(x, y) {
  const deepest = x.indexOf(Math.max(...x));
  return { x: x.slice(0, deepest + 1), y: y.slice(0, deepest + 1) };
}

function overTime(numbers, quantity) {
  const { course } = numbers;
  if (quantity.key === "reaction_force_N") return { x: course.time_s, y: course.reaction_force_N };
  const charge = sum(course.charge_pC);
  if (quantity.key === "film_charge_pC") return { x: course.time_s, y: charge };
  return { x: course.time_s, y: charge.map((one) => one / numbers.film.capacitance_pF) };
}

// A recorded press: its depth begins where it touches, which its phases say; null where the run has no such channel.
function recorded(run, quantity, over) {
  const name = Object.keys(run.channels).find((one) => quantity.channel.test(one)),
    loading = run.phases.find((one) => one.name === "loading");
  if (!name || !loading) return null;
  const first = run.time_s.findIndex((one) => one >= loading.from_s),
    shown = (values) => values.slice(first);
  if (over === "time")
    return { x: shown(run.time_s).map((one) => one - loading.from_s), y: shown(run.channels[name]) };
  const depth = run.channels.displacement_mm || run.channels.indentation_mm;
  if (!depth) return null;
  const rows = run.time_s
    .map((time, i) => [time, depth[i] - depth[first], run.channels[name][i]])
    .filter(([time]) => time >= loading.from_s && time <= loading.to_s);
  rows.sort((a, b) => a[1] - b[1]);
  return { x: rows.map((one) => one[1]), y: rows.map((one) => one[2]) };
}

// The height of a curve above a place between its points.
function heightAt({ x, y }, at) {
  const after = x.findIndex((one) => one >= at);
  if (after < 0 || at < x[0]) return null;
  if (after === 0) return y[0];
  return y[after - 1] + ((y[after] - y[after - 1]) * (at - x[after - 1])) / (x[after] - x[after - 1] || 1);
}

// One of the three plots.
class Plot {
  constructor(quantity, say, synced) {
    this.quantity = quantity;
    this.synced = synced;
    this.series = [];
    this.chart = element("div", { class: "chart", tabindex: 0, role: "img" });
    this.told = element("p", { class: "told", "aria-hidden": "true" });
    this.title = element("span", {}, `${quantity.title} (${quantity.unit})`);
    this.back = element("button", { type: "button", hidden: true, onclick: () => this.reset() }, "Whole");
    const hear = element(
      "button",
      {
        type: "button",
        "aria-label": `Hear ${quantity.title}`,
        title: "Hear it: pitch is its height. In the curve, arrow keys go from point to point",
        onclick: () => this.heard.whole(),
      },
      "♪",
    );
    const picture = element(
      "button",
      { type: "button", "aria-label": `${quantity.title} as PNG`, onclick: () => this.picture() },
      "PNG",
    );
    this.table = element(
      "details",
      { ontoggle: () => this.fill() },
      element("summary", {}, "Table"),
      element("div", { class: "wide" }),
    );
    this.box = element(
      "figure",
      { class: "plot" },
      element("figcaption", {}, this.title, this.back, hear, picture),
      this.chart,
      this.told,
      this.table,
    );
    this.heard = new Heard(
      this.chart,
      () => this.series.filter((one) => one.x.length),
      { title: quantity.title, x: "depth (mm)", y: `${quantity.title} (${quantity.unit})` },
      say,
    );
    new ResizeObserver(() => this.size()).observe(this.chart);
  }

  // series: [{name, x, y, colour, dash, width, error}]; across: what lies along the axis.
  show(series, across) {
    this.series = series;
    this.heard.axes.x = this.across = across;
    const now = series[0];
    this.chart.setAttribute(
      "aria-label",
      now
        ? `${this.quantity.title}: ${short(last(now.y))} ${this.quantity.unit} at ${short(last(now.x))} ${across}; ` +
            "arrow keys go along the curve, Enter plays it"
        : this.quantity.title,
    );
    this.draw();
    this.fill();
  }

  draw() {
    if (this.plot) this.plot.destroy();
    this.plot = null;
    if (!this.series.length || !this.chart.clientWidth) return;
    const tables = this.series.map(({ x, y }) => [x, y]),
      data = tables.length > 1 ? uPlot.join(tables) : tables[0];
    const axis = {
      stroke: colour("--soft"),
      grid: { stroke: colour("--line"), width: 1 },
      ticks: { stroke: colour("--line") },
      font: "11px system-ui, sans-serif",
    };
    const heights = this.series
      .flatMap((one) => [...one.y, last(one.y) + (one.error || 0), last(one.y) - (one.error || 0)])
      .filter(Number.isFinite);
    const options = {
      width: this.chart.clientWidth,
      height: this.chart.clientHeight,
      legend: { show: false },
      padding: [8, 8, 0, 0],
      scales: {
        x: { time: false },
        y: {
          range: (_, low, high) =>
            uPlot.rangeNum(Math.min(0, low, ...heights), Math.max(0, high, ...heights), 0.06, true),
        },
      },
      axes: [
        {
          ...axis,
          size: 36,
          label: this.across,
          labelSize: 14,
          labelFont: "11px system-ui, sans-serif",
          gap: 2,
        },
        { ...axis, size: 46, gap: 3, values: (_, all) => all.map((one) => short(one).replace("-", "−")) },
      ],
      series: [
        {},
        ...this.series.map((one) => ({
          label: one.name,
          stroke: colour(one.colour),
          width: one.width || 1.6,
          dash: one.dash,
          spanGaps: true,
          points: { show: Boolean(one.points), size: 6 },
        })),
      ],
      cursor: { sync: { key: this.synced }, drag: { x: true, y: false }, points: { size: 7 } },
      hooks: {
        setCursor: [(plot) => this.tell(plot)],
        draw: [(plot) => this.errors(plot)],
        setScale: [
          (plot, name) => {
            if (name === "x") this.zoomed(plot, data);
          },
        ],
      },
    };
    this.plot = new uPlot(options, data, this.chart);
  }

  zoomed(plot, data) {
    const { min, max } = plot.scales.x;
    this.back.hidden = !(min > data[0][0] || max < last(data[0]));
  }

  reset() {
    this.draw();
    this.back.hidden = true;
  }

  // The uncertainty of the last point, as a bar with ends.
  errors(plot) {
    const { ctx } = plot;
    for (const one of this.series.filter((each) => each.error)) {
      const [x, y] = [plot.valToPos(last(one.x), "x", true), last(one.y)],
        ends = [y - one.error, y + one.error].map((value) => plot.valToPos(value, "y", true));
      ctx.save();
      ctx.setLineDash([]);
      ctx.strokeStyle = colour(one.colour);
      ctx.lineWidth = 1.5 * devicePixelRatio;
      ctx.beginPath();
      ctx.moveTo(x, ends[0]);
      ctx.lineTo(x, ends[1]);
      for (const end of ends) {
        ctx.moveTo(x - 4 * devicePixelRatio, end);
        ctx.lineTo(x + 4 * devicePixelRatio, end);
      }
      ctx.stroke();
      ctx.restore();
    }
  }

  // What every curve is worth under the mouse; the two other plots show their cursor alone.
  tell(plot) {
    const { left, top } = plot.cursor,
      here = this.chart.matches(":hover");
    if (!here || left === null || left < 0) {
      this.told.replaceChildren();
      return;
    }
    const at = plot.posToVal(left, "x"),
      lines = this.series.map((one) => [one, heightAt(one, at)]).filter(([, value]) => value !== null);
    this.told.replaceChildren(
      element("span", {}, `${short(Number(at.toPrecision(3)))} ${this.across}`),
      ...lines.map(([one, value]) => {
        const line = element(
          "span",
          {},
          `${one.name}: ${short(Number(value.toPrecision(3)))} ${this.quantity.unit}`,
        );
        line.style.color = colour(one.colour);
        return line;
      }),
    );
    const wide = this.chart.clientWidth;
    this.told.style.left = left > wide / 2 ? "" : `${left + 62}px`;
    this.told.style.right = left > wide / 2 ? `${wide - left - 40}px` : "";
    this.told.style.top = `${Math.max(24, top)}px`;
  }

  size() {
    if (!this.plot) this.draw();
    else if (this.chart.clientWidth)
      this.plot.setSize({ width: this.chart.clientWidth, height: this.chart.clientHeight });
  }

  // The numbers behind the curves.
  fill() {
    if (!this.table.open) return;
    const heads = this.series.flatMap((one) => [
      element("th", { scope: "col" }, this.across),
      element("th", { scope: "col" }, `${one.name} (${this.quantity.unit})`),
    ]);
    const most = Math.max(0, ...this.series.map((one) => one.x.length));
    const rows = Array.from({ length: most }, (_, i) =>
      element(
        "tr",
        {},
        ...this.series.flatMap((one) =>
          [one.x[i], one.y[i]].map((value) => element("td", {}, value === undefined ? "" : short(value))),
        ),
      ),
    );
    const made = element(
      "table",
      {},
      element("thead", {}, element("tr", {}, ...heads)),
      element("tbody", {}, ...rows),
    );
    this.table.lastElementChild.replaceChildren(made);
    this.table.lastElementChild.tabIndex = 0;
  }

  // The plot with its title and the names of its curves.
  picture() {
    if (!this.plot) return;
    const source = this.plot.ctx.canvas,
      ratio = devicePixelRatio,
      head = (24 + 16 * this.series.length) * ratio;
    const made = element("canvas", { width: source.width, height: source.height + head }),
      draw = made.getContext("2d");
    draw.fillStyle = colour("--card");
    draw.fillRect(0, 0, made.width, made.height);
    draw.drawImage(source, 0, head);
    draw.font = `600 ${13 * ratio}px system-ui, sans-serif`;
    draw.fillStyle = colour("--ink");
    draw.fillText(this.title.textContent, 8 * ratio, 17 * ratio);
    draw.font = `${12 * ratio}px system-ui, sans-serif`;
    this.series.forEach((one, i) => {
      draw.fillStyle = colour(one.colour);
      draw.fillText(`— ${one.name}`, 8 * ratio, (34 + 16 * i) * ratio);
    });
    made.toBlob((blob) => download(blob, `${this.quantity.title.toLowerCase().replaceAll(" ", "-")}.png`));
  }
}

// All plots. designs: [{name, numbers, colour, dash, hidden, isNow}]; runs: [{name, run, colour, dash, hidden}] of a
// recording, which lie over them.
export class Curves {
  constructor(place, say) {
    this.place = place;
    this.designs = [];
    this.runs = [];
    this.over = "depth";
    this.plots = QUANTITIES.map((quantity) => new Plot(quantity, say, "studio"));
    place.replaceChildren(...this.plots.map((one) => one.box));
    for (const input of findAll("input[name=over]")) {
      input.addEventListener("change", () => {
        this.over = input.value;
        this.draw();
      });
    }
    find("#csv").addEventListener("click", () => this.csv());
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
  }

  show(designs, runs) {
    this.designs = designs;
    this.runs = runs;
    this.draw();
  }

  draw() {
    const across = this.over === "time" ? "time (s)" : "depth (mm)";
    for (const plot of this.plots)
      plot.show([...this.ofDesigns(plot.quantity), ...this.ofRuns(plot.quantity)], across);
  }

  ofDesigns(quantity) {
    return this.designs
      .filter((one) => !one.hidden && one.numbers)
      .map(({ name, numbers, colour: paint, dash, isNow }) => {
        const percent = (numbers.uncertainty || {})[quantity.error],
          end = last(numbers[quantity.key]);
        const drawn =
          this.over === "time"
            ? overTime(numbers, quantity)
            : wayIn(numbers.indentation_mm, numbers[quantity.key]);
        const error = this.over === "time" || !percent ? 0 : (percent / 100) * Math.abs(end);
        return {
          name,
          ...drawn,
          colour: paint,
          dash,
          width: isNow ? 2.4 : 1.6,
          points: isNow && this.over === "depth",
          error,
        };
      });
  }

  ofRuns(quantity) {
    const shown = this.runs
      .filter((one) => !one.hidden)
      .map(({ run, ...looks }) => {
        return { ...looks, width: 1.6, ...recorded(run, quantity, this.over) };
      });
    return shown.filter((one) => one.x && one.x.length > 1);
  }

  // Every curve that is shown, a block of columns each.
  csv() {
    const columns = this.plots.flatMap(({ quantity, series, across }) =>
      series.flatMap((one) => [
        [`${one.name}: ${across} of ${quantity.title}`, one.x],
        [`${one.name}: ${quantity.title} (${quantity.unit})`, one.y],
      ]),
    );
    const most = Math.max(0, ...columns.map(([, values]) => values.length)),
      quoted = (text) => `"${text.replaceAll('"', '""')}"`;
    const lines = [
      columns.map(([name]) => quoted(name)).join(","),
      ...Array.from({ length: most }, (_, i) => columns.map(([, values]) => values[i] ?? "").join(",")),
    ];
    download(new Blob([lines.join("\r\n") + "\r\n"], { type: "text/csv" }), "curves.csv");
  }
}
