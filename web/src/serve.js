/**
 * The page of `printprep view --serve`: settings that run the model again, with progress.
 */
import { element, input, readPage, say } from "./page.js";

const POLL_MS = 350;
const FOLLOWED = ["kicker", "key", "summary", "figures", "findings", "more"];

/**
 * @typedef {object} State what the server says about its run
 * @property {number} run number of the run that the page shows when it is done
 * @property {boolean} busy
 * @property {string | null} stage
 * @property {number} seconds
 * @property {string | null} error
 * @property {string | null} hint
 */

/**
 * @param {(view: import("./page.js").View, geometry: string) => Promise<void>} follow
 */
export function wireServe(follow) {
  const form = document.getElementById("settings");
  if (form === null) {
    return;
  }
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    void run(/** @type {HTMLFormElement} */ (form), follow);
  });
}

/**
 * @param {HTMLFormElement} form
 * @param {(view: import("./page.js").View, geometry: string) => Promise<void>} follow
 */
async function run(form, follow) {
  const values = Object.fromEntries(new FormData(form).entries());
  try {
    const asked = await fetch("run", {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify(values),
    });
    const answer = await asked.json();
    if (!asked.ok) {
      tell(`${answer.error} ${answer.hint ?? ""}`, true);
      return;
    }
    await wait(answer.run, follow);
  } catch {
    tell("The server does not answer. Start printprep view --serve again.", true);
  }
}

/**
 * @param {number} number
 * @param {(view: import("./page.js").View, geometry: string) => Promise<void>} follow
 */
async function wait(number, follow) {
  for (;;) {
    const state = /** @type {State} */ (await (await fetch("state")).json());
    if (state.run !== number) {
      return; // another run has begun since
    }
    if (!state.busy) {
      element("progress").hidden = true;
      if (state.error !== null) {
        tell(`${state.error} ${state.hint ?? ""}`, true);
      } else {
        await take(follow);
        tell(`Done in ${state.seconds.toFixed(1)} s.`, false);
      }
      return;
    }
    element("progress").hidden = false;
    tell(`${state.stage ?? "Starting"} … ${state.seconds.toFixed(0)} s`, false);
    await new Promise((done) => setTimeout(done, POLL_MS));
  }
}

/**
 * Takes the figures and the geometry of the new page into this one.
 * @param {(view: import("./page.js").View, geometry: string) => Promise<void>} follow
 */
async function take(follow) {
  const text = await (await fetch("./", { cache: "no-store" })).text();
  const page = new DOMParser().parseFromString(text, "text/html");
  for (const id of FOLLOWED) {
    element(id).replaceChildren(...document.adoptNode(element(id, page)).childNodes);
  }
  element("download").hidden = element("download", page).hidden;
  input("lean").value = "0";
  const { view, geometry } = readPage(page);
  await follow(view, geometry);
}

/**
 * @param {string} message
 * @param {boolean} bad
 */
function tell(message, bad) {
  const status = element("run-status");
  status.textContent = message;
  status.classList.toggle("bad", bad);
  if (bad || message.startsWith("Done")) {
    say(message);
  }
}
