// A goal, such as 10 V at the least force: the sliders move to the design that meets it.
import { element, short } from "./dom.js";
import { numberOf, quantity } from "./numbers.js";
import { GIVEN, given } from "./quantities.js";

// An estimate reaches no farther than a factor of two.
const FARTHEST = 2;
const OF_SEGMENT = "segment.";

const sizes = (found, key) => quantity(found, given(key).unit);

export class GoalPanel {
  // form: the question; place: the answer; ask(message): tells the program.
  constructor(form, place, ask) {
    this.form = form;
    this.place = place;
    this.ask = ask;
    this.boxes = {};
    this.find = (selector) => form.querySelector(selector);
    for (const [name, chosen] of [
      ["enough", "voltage_V"],
      ["least", "force_N"],
    ]) {
      const options = GIVEN.map((one) => element("option", { value: one.key }, this.words(name, one)));
      this.find(`.${name}`).replaceChildren(...options);
      this.find(`.${name}`).value = chosen;
    }
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      this.start();
    });
  }

  words(name, { name: words, unit }) {
    return name === "enough" ? `${words} (${unit})` : words;
  }

  start() {
    const numbers = Object.values(this.boxes)
      .filter(({ box, number }) => box.checked && number.now > 0)
      .map(({ number: { path, now, low, high } }) => [
        path,
        Math.max(low, now / FARTHEST),
        Math.min(high, now * FARTHEST),
      ]);
    const [enough, least] = [this.find(".enough").value, this.find(".least").value];
    this.ask({ do: "start", task: "goal", enough, least, target: numberOf(this.find(".target").value), numbers });
  }

  // Numbers of the form, and whether a family answers for the design, whose numbers move then.
  offer(numbers, isOfFamily) {
    this.find("details").hidden = isOfFamily;
    const before = this.boxes;
    this.boxes = {};
    for (const number of numbers.filter((one) => one.now > 0)) {
      const known = before[number.key],
        box = known ? known.box : element("input", { type: "checkbox", checked: number.key.startsWith(OF_SEGMENT) });
      this.boxes[number.key] = { box, number };
    }
    if (Object.keys(before).join() === Object.keys(this.boxes).join()) return;
    const labels = Object.values(this.boxes).map(({ box, number }) => element("label", {}, box, ` ${number.name}`));
    this.find(".numbers").replaceChildren(...labels);
  }

  // found: of the program, null where there is none; isCurrent: the design is still the one that it led to; estimate,
  // pressed: what is known of it by now.
  show(found, isCurrent, estimate, pressed) {
    if (!found) return this.place.replaceChildren();
    const goal = `${short(found.target)} ${given(found.enough).unit} with the least ${given(found.least).name}`;
    const said = element("p", {}, element("strong", {}, `Goal: ${goal}. `));
    if (!isCurrent) said.append("The design has been changed since.");
    else if (!found.reached) said.append(this.beyond(found));
    else said.append(this.reached(found, estimate, pressed));
    return this.place.replaceChildren(said, ...this.buttons(found, isCurrent, pressed));
  }

  beyond({ by, gives, enough }) {
    const most = sizes(gives, enough);
    return by === "family"
      ? `No design of the family gives that; its nearest one gives ${most}. Nothing was moved.`
      : `Out of reach by the estimate: at most ${most}, where the numbers that may move change by a factor of ` +
          `${FARTHEST} together. Nothing was moved: let others move, ask for less, or go on from the nearest design.`;
  }

  reached({ changes, by, enough, least, target }, estimate, pressed) {
    const words = changes.map(([path, value]) => this.told(path, value));
    const moved = words.length ? `Moved: ${words.join(", ")}. ` : "Nothing had to be moved. ";
    if (pressed) {
      const found = `${sizes(pressed[enough], enough)} with ${sizes(pressed[least], least)}`;
      return `${moved}Its press gives ${found}: the goal is ${Math.abs(pressed[enough]) >= target ? "met" : "missed"}.`;
    }
    const of = by === "family" ? "The family answers" : "The estimate gives";
    const one = (key) => quantity(estimate[key].value, given(key).unit, estimate[key].error);
    return estimate
      ? `${moved}${of} ${one(enough)} with ${one(least)}; its press follows.`
      : `${moved}Its press follows.`;
  }

  // A number as the form names it, at its value.
  told(path, value) {
    const key = JSON.stringify(path),
      known = Object.values(this.boxes).find(({ number }) => JSON.stringify(number.path) === key);
    const { name, unit } = known ? known.number : { name: path[path.length - 1], unit: "" };
    return `${name} ${short(value)} ${unit}`.trim();
  }

  buttons(found, isCurrent, pressed) {
    const made = (words, action) => element("button", { type: "button", onclick: action }, words);
    if (isCurrent && !found.reached && found.changes.length)
      return [made("Go to the nearest design", () => this.ask({ do: "change", changes: found.changes }))];
    const missed = isCurrent && found.reached && pressed && Math.abs(pressed[found.enough]) < found.target;
    if (missed || !isCurrent) return [made("Seek again from here", () => this.start())];
    return [];
  }
}
