// Recordings: what is dropped is sent, shown with its phases, diagnosed.
import { channel } from "./charts.js";
import { element, find, worded } from "./dom.js";

const PHASES = ["approach", "loading", "hold", "unloading", "after"];
const WANTED = /\.(toml|csv|zip)$/i;
const MOST_MB = 25,
  MOST_FILES = 500;

const EVIDENCE = {
  where: "Where recordings and simulation differ",
  run: "A run, recorded and simulated",
  components: "Which part the excess resembles",
  gains: "Which explanation predicts best",
};
const rank = (name) => Object.keys(EVIDENCE).indexOf(name.split("-")[0]);

// Files of what was dropped, those of folders with their way; one more than are read at most.
async function below(entry, found, way = "") {
  if (entry.isFile) {
    if (WANTED.test(entry.name))
      found.push([way + entry.name, await new Promise((given, lost) => entry.file(given, lost))]);
    return;
  }
  const reader = entry.createReader();
  while (found.length <= MOST_FILES) {
    const some = await new Promise((given, lost) => reader.readEntries(given, lost));
    if (!some.length) break;
    for (const one of some) await below(one, found, `${way}${entry.name}/`);
  }
}

async function dropped(entries) {
  const found = [];
  for (const one of entries) await below(one, found);
  return found;
}

// files: [[name, File], ...]; the head of what is sent lists their names and sizes.
async function send(files, address, say) {
  const wanted = files.filter(([name]) => WANTED.test(name));
  const total = wanted.reduce((sum, [, file]) => sum + file.size, 0) / 1e6;
  if (!wanted.length)
    return say("There is no recording in it: a recording is a folder with rig.toml and CSV files.", true);
  if (wanted.length > MOST_FILES)
    return say(
      `There are more than ${MOST_FILES} files in it, which are not read; drop the folder of one recording.`,
      true,
    );
  if (total > MOST_MB)
    return say(
      `This recording has ${total.toFixed(0)} MB, at most ${MOST_MB} MB are read here; ` +
        "thin it out, or use softdot diagnose.",
      true,
    );
  const head = JSON.stringify(wanted.map(([name, file]) => [name, file.size])) + "\n";
  try {
    const answer = await fetch(address("/upload"), {
      method: "POST",
      body: new Blob([head, ...wanted.map(([, file]) => file)]),
    });
    if (!answer.ok) say(await answer.text(), true);
  } catch {
    say("The recording could not be sent.", true);
  }
  return undefined;
}

export function prepare(address, say) {
  for (const place of [find("#drop"), find("#curves")]) {
    for (const kind of ["dragover", "dragleave", "drop"]) {
      place.addEventListener(kind, (event) => {
        event.preventDefault();
        place.classList.toggle("over", kind === "dragover");
      });
    }
    place.addEventListener("drop", async (event) => {
      const items = [...event.dataTransfer.items].map(
        (one) => one.webkitGetAsEntry && one.webkitGetAsEntry(),
      );
      const entries = items.filter(Boolean),
        files = [...event.dataTransfer.files].map((file) => [file.name, file]);
      try {
        await send(entries.length ? await dropped(entries) : files, address, say);
      } catch {
        say("What was dropped cannot be read.", true);
      }
    });
  }
  const drop = find("#drop");
  for (const kind of ["folder", "zip"]) {
    const input = drop.querySelector(`.${kind}-file`);
    drop.querySelector(`.${kind}`).addEventListener("click", () => input.click());
    input.addEventListener("change", () => {
      send(
        [...input.files].map((file) => [file.webkitRelativePath || file.name, file]),
        address,
        say,
      );
      input.value = "";
    });
  }
}

export function show(result, ask, units) {
  const runs = result.runs.map((run) =>
    element(
      "figure",
      {},
      element(
        "figcaption",
        {},
        element("strong", {}, run.label),
        ` – driven by ${worded(run.drive, units)[0]}, ${run.samples.toLocaleString("en")} samples`,
      ),
      ...Object.entries(run.channels).map(([name, y]) => {
        const [title, unit] = worded(name, units);
        const bands = run.phases.map((phase) => ({
          from: phase.from_s,
          to: phase.to_s,
          name: phase.name,
          kind: PHASES.indexOf(phase.name),
        }));
        return channel({ title, unit, x: run.time_s, y, bands });
      }),
    ),
  );
  const start = (quick) =>
    element(
      "button",
      { type: "button", onclick: () => ask({ do: "start", task: "diagnosis", quick }) },
      quick ? "Quick diagnosis" : "Diagnosis, checked by the full model",
    );
  find("#recording").replaceChildren(
    element(
      "p",
      {},
      `A recording of ${result.of}: ${result.runs.length} run${result.runs.length === 1 ? "" : "s"}. ` +
        "The coloured bands are approach, loading, hold, unloading and after.",
    ),
    ...result.warnings.map((one) => element("p", { class: "soft" }, `warning: ${one}`)),
    element("div", { class: "row" }, start(true), start(false)),
    element("div", { id: "verdict", "aria-live": "polite" }),
    ...runs,
  );
}

export function verdict(result, ask, address) {
  const place = find("#verdict");
  if (!place) return;
  const plots = Object.entries(result.plots || {})
    .sort(([a], [b]) => rank(a) - rank(b))
    .map(([name, token]) => {
      const [kind, number] = name.split("-"),
        words = EVIDENCE[kind] + (number ? `, number ${number}` : "");
      return element(
        "figure",
        {},
        element("figcaption", {}, words),
        element("img", { src: address(`/files/${token}`), alt: words }),
      );
    });
  const take = result.improved
    ? element(
        "button",
        { type: "button", onclick: () => ask({ do: "improve" }) },
        "Take the improved model over as the design",
      )
    : null;
  place.replaceChildren(
    element(
      "div",
      { class: "verdict" },
      element("strong", {}, `Verdict: ${result.grade}`),
      ...result.said.map((one) => element("p", {}, one)),
      take,
    ),
    ...plots,
  );
}
