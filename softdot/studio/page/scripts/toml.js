// The design as text: line numbers, and marks at the lines of mistakes. And the tabs that show form or text.
import { element, find } from "./dom.js";

// The line of a dotted key such as mechanisms[1].parameters.strain_x, counted from 0; of a key that is not there the
// head of its table; null where neither is. A mistake in the writing itself names its line.
export function lineOf(text, sentence) {
  const written = sentence.match(/\bline (\d+)/);
  if (written) return Number(written[1]) - 1;
  const key = sentence.split(/[ :]/, 1)[0],
    counts = {};
  let table = "",
    found = null;
  text.split("\n").forEach((line, number) => {
    const repeated = line.match(/^\s*\[\[([^\]]+)\]\]/),
      single = line.match(/^\s*\[([^\]]+)\]/),
      own = line.match(/^\s*([\w."-]+)\s*=/);
    if (repeated) {
      counts[repeated[1]] = (counts[repeated[1]] ?? -1) + 1;
      table = `${repeated[1]}[${counts[repeated[1]]}]`;
    } else if (single) table = single[1];
    const whole = own && !repeated && !single ? (table ? `${table}.` : "") + own[1] : table;
    if (whole && (key === whole || key.startsWith(`${whole}.`) || key.startsWith(`${whole}[`))) {
      if (found === null || whole.length > found.length) found = { number, length: whole.length };
    }
  });
  return found && found.number;
}

export class Editor {
  constructor(area, lines) {
    this.area = area;
    this.lines = lines;
    this.mistakes = [];
    area.addEventListener("input", () => this.number());
    area.addEventListener("scroll", () => {
      lines.scrollTop = area.scrollTop;
    });
    new ResizeObserver(() => {
      lines.scrollTop = area.scrollTop;
    }).observe(area);
  }

  mark(mistakes) {
    this.mistakes = mistakes;
    this.number();
  }

  number() {
    const text = this.area.value,
      bad = new Map(this.mistakes.map((one) => [lineOf(text, one), one]));
    const count = text.split("\n").length;
    this.lines.replaceChildren(
      ...Array.from({ length: count }, (_, i) =>
        element("span", { class: bad.has(i) ? "bad" : null, title: bad.get(i) }, String(i + 1)),
      ),
    );
    this.lines.scrollTop = this.area.scrollTop;
  }
}

// Two tabs, of which the arrow keys change; the choice is kept in this tab of the browser.
export function prepareTabs() {
  const tabs = ["form", "toml"].map((name) => find(`#tab-${name}`)),
    panels = tabs.map((one) => find(`#${one.getAttribute("aria-controls")}`));
  const choose = (number) => {
    tabs.forEach((one, i) => {
      one.setAttribute("aria-selected", String(i === number));
      one.tabIndex = i === number ? 0 : -1;
      panels[i].hidden = i !== number;
    });
    sessionStorage.setItem("design-tab", String(number));
  };
  tabs.forEach((one, number) => {
    one.addEventListener("click", () => choose(number));
    one.addEventListener("keydown", (event) => {
      if (event.key !== "ArrowLeft" && event.key !== "ArrowRight") return;
      choose(1 - number);
      tabs[1 - number].focus();
    });
  });
  choose(Number(sessionStorage.getItem("design-tab") || 0));
}
