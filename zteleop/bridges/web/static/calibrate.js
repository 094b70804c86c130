// @ts-check
/** The questions of `zteleop calibrate`: what is asked goes to where it is read, what is pressed to the robot. */

import { Bus } from "./bus.js";
import { TOKEN } from "./token.js";

const KEYS = /** @type {Record<string, string>} */ ({
  ArrowUp: "up",
  ArrowDown: "down",
  ArrowLeft: "left",
  ArrowRight: "right",
  PageUp: "pageup",
  PageDown: "pagedown",
  Enter: "enter",
  Space: "space",
  Backspace: "backspace",
  KeyS: "s",
  KeyB: "b",
  KeyK: "k",
  KeyR: "r",
  KeyQ: "q",
});
/** What the four buttons beside the ticks press, and what they are called. */
const TURNS = /** @type {Record<string, [string, string][]>} */ ({
  throttle: [["pagedown", "down 10"], ["down", "down 1"], ["up", "up 1"], ["pageup", "up 10"]],
  steering: [["pageup", "left 10"], ["left", "left 1"], ["right", "right 1"], ["pagedown", "right 10"]],
});
const NOTHING = { drive: 0, turn: 0, deadman: false };

/** @param {string} id */
const at = (id) => /** @type {HTMLElement} */ (document.getElementById(id));
/**
 * @param {string} id
 * @param {string} text
 */
const show = (id, text) => {
  if (at(id).textContent !== text) at(id).textContent = text;
};

const known = { beat: 0, axis: "", ended: false };
const bus = new Bus(TOKEN, () => NOTHING, hear, () => {}, connected);

/** @param {string} key */
function press(key) {
  bus.say({ is: "press", key, beat: known.beat });
}

/** @param {boolean} open */
function connected(open) {
  if (open || known.ended) return;
  at("state").dataset.state = "away";
  show("state", "not connected");
  tell("looking for zteleop calibrate: is it still running?");
  offer(false);
}

/** @param {import("./bus.js").Word} word */
function hear(word) {
  switch (word.is) {
    case "hello":
      show("robot", word.robot);
      document.title = `${word.robot} – zteleop calibrate`;
      break;
    case "told":
      told(word);
      break;
    case "asks":
      asks(word);
      break;
    case "note":
      note(word.says);
      break;
  }
}

/** @param {string} words */
function tell(words, hint = "") {
  show("asks", words);
  show("hint", hint);
}

/** @param {string} words */
function note(words) {
  show("note", words);
  at("note").hidden = !words;
}

/** @param {boolean} is there is a question to answer */
function offer(is) {
  for (const id of ["turn", "answers", "idle"]) at(id).hidden = !is;
}

/** @param {import("./bus.js").Word} word what there is to do where nothing is asked */
function told(word) {
  tell(word.lines.join("\n"));
  note("");
  offer(false);
  show("step", "");
  at("begin").hidden = !word.begins;
  show("begin", word.begins);
  at("state").dataset.state = "idle";
  show("state", word.ends ? "done" : word.begins ? "waits for you" : "starting");
  at("release").hidden = true;
  for (const id of ["stop", "leave", "figures"]) at(id).hidden = Boolean(word.begins) || word.ends;
  if (!word.ends) return;
  known.ended = true;
  press("seen");
}

/** @param {import("./bus.js").Word} word a question, and how the robot stands */
function asks(word) {
  known.beat = word.beat;
  if (known.axis !== word.axis) label(word.axis);
  at("begin").hidden = true;
  for (const id of ["stop", "leave", "figures"]) at(id).hidden = false;
  offer(true);
  show("step", `${word.step} of ${word.steps}`);
  const upsideDown = word.axis === "steering" ? "a servo that is built in upside down turns the other way, and is found out" : "";
  const hint = word.brakes ? "many an ESC brakes first: then neutral, and down once more" : upsideDown;
  tell(`Turn the ${word.axis} until ${word.asks}.`, hint);
  note(word.note);
  at("state").dataset.state = word.state;
  show("state", word.state);
  show("why", word.why);
  show("ticks", String(word.out[word.axis] ?? "-"));
  /** @type {HTMLProgressElement} */ (at("idle")).value = word.idle_left || 0;
  at("release").hidden = word.state !== "stopped";
  const rows = word.found.map((/** @type {string} */ line) => {
    const row = document.createElement("tr");
    row.append(Object.assign(document.createElement("td"), { textContent: line }));
    return row;
  });
  if (at("found").textContent !== word.found.join("")) at("found").replaceChildren(...rows);
}

/** @param {string} axis the servo that the buttons turn */
function label(axis) {
  known.axis = axis;
  document.querySelectorAll("#turn button").forEach((button, place) => {
    const [key, words] = TURNS[axis][place];
    /** @type {HTMLElement} */ (button).dataset.key = key;
    button.textContent = words;
  });
}

at("begin").addEventListener("click", () => press("begin"));
for (const button of /** @type {NodeListOf<HTMLElement>} */ (document.querySelectorAll("[data-key]")))
  button.addEventListener("click", (event) => {
    press(button.dataset.key || "");
    if (event.detail) button.blur(); // else the space bar, which is neutral, would press it once more
  });
addEventListener("keydown", (event) => {
  const key = KEYS[event.code];
  if (!key || event.repeat || event.ctrlKey || event.altKey || event.metaKey) return;
  const isClick = event.target instanceof HTMLButtonElement && (key === "enter" || key === "space");
  if (isClick || !at("begin").hidden) return; // the button that has the focus takes it
  event.preventDefault();
  press(key);
});
