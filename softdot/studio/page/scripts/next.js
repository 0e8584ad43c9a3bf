// The right side: warnings, what moves the voltage, work for the bench, comparison.
import { tornado } from "./charts.js";
import { duration, element, find } from "./dom.js";
import { go, named } from "./form_search.js";

export const TITLES = {
  kit: "Kit",
  report: "Report and CAD",
  plate: "Braille plate",
  influences: "What moves the voltage",
  tolerances: "Tolerances",
  recording: "Recording",
  diagnosis: "Diagnosis",
  response: "Presses along one number",
  goal: "Goal",
};

// Work whose progress stands in a panel of its own.
const PLACES = {
  recording: "#drop-tasks",
  diagnosis: "#drop-tasks",
  response: "#response-tasks",
  goal: "#goal-tasks",
};

function mending(sentence, remedy, ask) {
  const button =
    remedy &&
    element(
      "button",
      { type: "button", onclick: () => ask({ do: "change", changes: remedy.changes }) },
      `Mend it: ${remedy.says}`,
    );
  const field = named(find("#form"), sentence);
  const there = field && element("button", { type: "button", onclick: () => go(field) }, "Show the number");
  return element("li", {}, sentence, element("span", { class: "row" }, button, there));
}

export function mistakes(state, ask) {
  find("#mistakes").replaceChildren(...state.mistakes.map((one, i) => mending(one, state.remedies[i], ask)));
}

export function warnings(state, late, ask) {
  const items = state.warnings.map((one, i) => mending(one, state.remedies[i], ask));
  for (const one of late)
    if (!state.warnings.includes(one.text)) items.push(mending(one.text, one.remedy, ask));
  find("#warnings").replaceChildren(...(items.length ? items : [element("li", { class: "soft" }, "None.")]));
}

export function cost(state) {
  const found = state.cost;
  find("#cost").textContent = found
    ? `The report presses about ${found.tetrahedra.toLocaleString("en")} elements, ` +
      `in about ${duration(found.time_s)} and ${found.memory_GB} GB.`
    : "";
}

export function influences(result, title) {
  const rows = result.rows.slice(0, 14).map((row) => ({ label: row.label, value: row.voltage_percent }));
  const body = result.rows.map((row) =>
    element(
      "tr",
      {},
      element("th", { scope: "row" }, row.label),
      element("td", {}, `${row.voltage_percent.toFixed(1)} %`),
      element("td", {}, `${row.force_percent.toFixed(1)} %`),
    ),
  );
  const head = element(
    "thead",
    {},
    element(
      "tr",
      {},
      element("th", { scope: "col" }, title),
      element("th", { scope: "col" }, "voltage"),
      element("th", { scope: "col" }, "force"),
    ),
  );
  find("#influences").replaceChildren(
    element("p", { class: "soft" }, `Change of the voltage, to first order, on a coarse mesh. ${title}.`),
    tornado(rows),
    element(
      "details",
      {},
      element("summary", {}, "As a table"),
      element("table", {}, head, element("tbody", {}, ...body)),
    ),
  );
}

// One entry for each kind of long work: how far it is, its cancel button, then what it made.
export class Tasks {
  constructor(ask, address) {
    this.ask = ask;
    this.address = address;
    this.items = {};
  }

  item(task) {
    if (!this.items[task]) {
      this.items[task] = element(
        "li",
        {},
        element("strong", {}, TITLES[task] || task),
        element("p", { class: "state" }),
        element("p", { class: "old", hidden: true }, "The design has been changed since."),
        element("progress", { max: 1, "aria-label": `Progress: ${TITLES[task]}` }),
        element("p", { class: "links" }),
        element("div", { class: "more" }),
        element("button", { type: "button", onclick: () => this.ask({ do: "cancel", task }) }, "Cancel"),
      );
      find(PLACES[task] || "#tasks").prepend(this.items[task]);
    }
    return this.items[task];
  }

  progress(told) {
    const item = this.item(told.task),
      bar = item.querySelector("progress");
    item.classList.remove("bad");
    const left = told.left_s && told.count ? `, ${duration(told.left_s)} left` : "";
    item.querySelector(".state").textContent =
      `${told.stage}${told.count ? ` ${told.done} of ${told.count}` : ""}${told.text ? `: ${told.text}` : ""}${left}`;
    if (told.known) item.querySelector(".more").replaceChildren(...told.known.map((one) => element("p", {}, one)));
    item.querySelector("button").hidden = false;
    bar.hidden = false;
    if (told.count) bar.value = told.done / told.count;
    else bar.removeAttribute("value");
  }

  done(told) {
    const item = this.item(told.task),
      { result } = told,
      links = [];
    const link = (token, text, extra) =>
      element("a", { href: this.address(`/files/${token}`), ...extra }, text);
    if (result.page && result.file)
      links.push(link(result.page, "Open the page", { target: "_blank", rel: "noopener noreferrer" }));
    if (result.file)
      links.push(link(result.file, `Download ${result.file.split("/").pop()}`, { download: true }));
    item.querySelector(".links").replaceChildren(...links);
    const said = [
      ...(result.said || []),
      ...(told.task === "recording" ? [] : result.warnings || []).map((one) => `warning: ${one}`),
    ];
    item.querySelector(".more").replaceChildren(...said.map((one) => element("p", {}, one)));
    if (told.took_s !== undefined) this.finish(item, `done in ${duration(told.took_s)}`);
  }

  ended(told) {
    const item = this.item(told.task);
    if (told.said) this.finish(item, told.said);
    item.classList.toggle("bad", Boolean(told.bad));
    item.querySelector("progress").hidden = true;
    item.querySelector("button").hidden = true;
  }

  finish(item, text) {
    item.querySelector(".state").textContent = text;
    item.querySelector("progress").hidden = true;
    item.querySelector("button").hidden = true;
  }
}
