// The designs that are kept: one list, which is drawn in the curves and compared.
import { breakable, element, find, short } from "./dom.js";
import { quantity } from "./numbers.js";

const DASHES = [
  [8, 4],
  [3, 3],
  [10, 3, 3, 3],
  [1, 4],
];
const last = (values) => (values && values.length ? values[values.length - 1] : null);

const answer = (numbers) =>
  [quantity(last(numbers.open_circuit_voltage_V), "V"), quantity(last(numbers.reaction_force_N), "N")].join(
    ", ",
  );

function patch(paint) {
  const made = element("span", { class: "patch" });
  made.style.background = `var(${paint})`;
  return made;
}

export class Designs {
  // ask(message): tells the program; drawn(list, runs): shows the curves of designs, the present one first, and of
  // a recording.
  constructor(ask, drawn) {
    this.ask = ask;
    this.drawn = drawn;
    this.now = null;
    this.kept = [];
    this.runs = [];
    this.rows = [];
    this.most = 4;
  }

  // The last press: of the present design, or of the one before.
  present({ numbers, quality }) {
    const name = quality === "coarse" ? "this design (coarse)" : "this design";
    this.now = {
      name,
      numbers,
      colour: "--series",
      isNow: true,
      hidden: Boolean(this.now && this.now.hidden),
    };
    this.show();
  }

  hear({ designs, rows, most }) {
    const looks = (i) => ({ colour: `--kept-${i % DASHES.length}`, dash: DASHES[i % DASHES.length] });
    this.kept = designs.map((one, i) => ({ ...one, number: i, ...looks(i) }));
    this.rows = rows;
    this.most = most;
    this.show();
  }

  // Runs of a recording, none where there is no recording.
  record(runs) {
    const looks = (i) => ({ colour: "--recorded", dash: [2, 3 + 2 * i] });
    this.runs = runs.map((run, i) => ({ name: `recorded: ${run.label}`, run, hidden: false, ...looks(i) }));
    this.show();
  }

  toggle(one) {
    if (this.kept.includes(one)) return this.ask({ do: "hide", number: one.number, hidden: !one.hidden });
    one.hidden = !one.hidden;
    return this.show();
  }

  show() {
    const list = [...(this.now ? [this.now] : []), ...this.kept];
    this.drawn(list, this.runs);
    find("#legend").replaceChildren(
      ...[...list, ...this.runs].map((one) =>
        element(
          "li",
          {},
          element(
            "button",
            {
              type: "button",
              "aria-pressed": String(!one.hidden),
              title: "Hide or show",
              onclick: () => this.toggle(one),
            },
            patch(one.colour),
            one.name,
          ),
        ),
      ),
    );
    find("#compare").replaceChildren(
      ...(this.kept.length
        ? [this.list(), this.table()]
        : [
            element(
              "p",
              { class: "soft" },
              `Keep up to ${this.most} designs: they stay in the curves, and here stands in what they differ.`,
            ),
          ]),
    );
  }

  list() {
    return element(
      "ul",
      { class: "kept", "aria-label": "Kept designs" },
      ...this.kept.map((one) => {
        const name = element("input", {
          type: "text",
          value: one.name,
          maxlength: 60,
          "aria-label": `Name of kept design ${one.number + 1}`,
        });
        name.addEventListener("change", () =>
          this.ask({ do: "rename", number: one.number, name: name.value }),
        );
        const numbers = one.numbers || {},
          button = (words, what, action) =>
            element(
              "button",
              { type: "button", "aria-label": `${what} ${one.name}`, onclick: action },
              words,
            );
        return element(
          "li",
          {},
          patch(one.colour),
          name,
          button("Use", "Go on with", () => this.ask({ do: "take", number: one.number })),
          button(one.hidden ? "Show" : "Hide", "Hide or show", () => this.toggle(one)),
          button("×", "Delete", () => this.ask({ do: "drop", number: one.number })),
          element("p", { class: "found" }, one.numbers ? answer(numbers) : "not pressed yet"),
        );
      }),
    );
  }

  table() {
    const head = element(
      "tr",
      {},
      element("td", {}),
      ...this.kept.map((one) => element("th", { scope: "col" }, one.name)),
    );
    const rows = this.rows.map((row) =>
      element(
        "tr",
        {},
        element("th", { scope: "row" }, ...breakable(row.label + (row.unit ? ` (${row.unit})` : ""))),
        ...row.cells.map((cell) => element("td", {}, short(cell))),
      ),
    );
    return element(
      "div",
      { class: "wide", tabindex: 0, role: "region", "aria-label": "Compared designs" },
      element("table", {}, element("thead", {}, head), element("tbody", {}, ...rows)),
    );
  }
}
