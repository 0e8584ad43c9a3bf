// Search in the form, what is shown of it, and the way to one field.
import { find } from "./dom.js";

// Whether a word occurs in a field or in the title of a group that holds it.
function holds(field, wanted) {
  if ((field.textContent + (field.dataset.about || "")).toLowerCase().includes(wanted)) return true;
  for (let group = field.closest("details"); group; group = group.parentElement.closest("details")) {
    if (group.querySelector("summary").textContent.toLowerCase().includes(wanted)) return true;
  }
  return false;
}

// Groups without a field that is shown are hidden.
export function tidy(root) {
  const all = root.matches(".every, .searching"),
    shown = `.field:not(.inert, .miss${all ? "" : ", .extra"})`;
  for (const group of root.querySelectorAll("details")) group.hidden = !group.querySelector(shown);
}

// Hide what a word does not occur in; what is found is opened.
export function filter(root, word) {
  const wanted = word.trim().toLowerCase();
  root.classList.toggle("searching", wanted !== "");
  for (const field of root.querySelectorAll(".field"))
    field.classList.toggle("miss", wanted !== "" && !holds(field, wanted));
  for (const field of root.querySelectorAll(".field.miss"))
    if (field.querySelector(".field:not(.miss)")) field.classList.remove("miss");
  tidy(root);
  for (const group of root.querySelectorAll("details")) {
    if (group.wasOpen === undefined) group.wasOpen = group.open;
    group.open = wanted === "" ? group.wasOpen : !group.hidden;
    if (wanted === "") delete group.wasOpen;
  }
}

// The field of the key with which a sentence begins, null where there is none.
export function named(root, sentence) {
  const key = sentence.split(/[ :]/, 1)[0];
  return [...root.querySelectorAll(".field[data-key]")].find((one) => one.dataset.key === key) || null;
}

// Open what hides a field and go there.
export function go(field) {
  const search = find("#find");
  find("#tab-form").click();
  search.value = "";
  search.dispatchEvent(new Event("input"));
  if (field.matches(".extra")) find("#every").click();
  for (let group = field.closest("details"); group; group = group.parentElement.closest("details"))
    group.open = true;
  field.scrollIntoView({ block: "center" });
  field.querySelector("input:not([type=range]), select").focus();
}

// What the field under the hand means, in the line below the form.
export function hints(root, place) {
  for (const kind of ["pointerover", "focusin"]) {
    root.addEventListener(kind, (event) => {
      const field = event.target.closest(".field");
      if (field) place.textContent = [field.dataset.key, field.dataset.about].filter(Boolean).join(": ");
    });
  }
}
