// @ts-check
/** The page: what is heard goes to where it is shown, what is pressed to the bus. */

import * as body from "./body.js";
import { Bus } from "./bus.js";
import { Eye } from "./eye.js";
import { Graph } from "./graph.js";
import { Held, touch } from "./held.js";
import { Log } from "./log.js";
import { Parameters } from "./parameters.js";
import { Phone } from "./phone.js";
import { Plot, save } from "./plot.js";
import * as robots from "./robots.js";
import { Rooms } from "./rooms.js";
import { tilt } from "./tilt.js";
import { TOKEN } from "./token.js";
import { Top } from "./top.js";
import { Topics } from "./topics.js";

const TOPICS = ["drive_status", "vehicle", "odom", "scene", "battery_state", "camera/image/compressed", "hazard_detection", "interface_buttons", "log"];
const BEATS = 20; // a second, of a robot that is heard without loss
const SILENT = 500; // ms without a status after which it is not so any more
const SOON = 600; // ms in which a robot that is there has answered

/**
 * @template {HTMLElement} [T=HTMLElement]
 * @param {string} id
 * @returns {T}
 */
const at = (id) => /** @type {T} */ (document.getElementById(id));
/**
 * @param {string} id
 * @param {string} text
 */
const show = (id, text) => {
  const place = at(id);
  if (place.textContent !== text) place.textContent = text;
};
/** @param {number} value */
const signed = (value) => (value < 0 ? "\u2212" : "+") + Math.abs(value).toFixed(2);
/** @param {any} twist */
const twisted = (twist) => `${signed(twist.linear.x)} m/s  ${signed(twist.angular.z)} rad/s`;

const held = new Held(document, () => bus.sayHeld());
const phone = new Phone();
const view = new Top(at("top"));
const known = { you: "", robot: "", holder: "", obeyed: false, refused: "", vehicle: /** @type {any} */ (null), latency: 0, heard: 0, since: 0, met: false, x: 0, y: 0 };
const eye = new Eye(at("eye"), (words) => show("camera", words));
const bus = new Bus(TOKEN, () => stick(), hear, (picture) => eye.see(picture), connected);
bus.topics.push(...TOPICS);
const plot = new Plot(at("plot-picture"), at("plot-lines"), at("plot-pause"), watch);
const topics = new Topics(at("topics-list"), at("topics-echo"), plot, watch);
const graph = new Graph(/** @type {any} */ (at("graph")), (topic) => {
  rooms.enter("topics");
  topics.choose(topic);
});
const log = new Log(at("log"), /** @type {HTMLInputElement} */ (at("log-warnings")));
const parameters = new Parameters(at("room-parameters"), (node, name, value) => bus.say({ is: "set", node, name, value }));
const rooms = new Rooms(at("rooms"), look);

/** Hear what is shown: always what the page is about, and what somebody has picked. */
function watch() {
  bus.watch([...TOPICS, ...plot.topics, topics.chosen].filter(Boolean));
  topics.tick();
}

/** Be told of nodes and topics, of parameters, of robots, for as long as a room shows them. */
function look() {
  const shown = (/** @type {string[]} */ ...names) => names.some((name) => !at(`room-${name}`).hidden);
  bus.say({ is: "look", graph: shown("topics", "graph"), parameters: shown("parameters"), robots: shown("robots") });
}

/** @returns {import("./bus.js").Stick} */
function stick() {
  const now = held.stick();
  if (now.deadman) phone.stayAwake();
  at("stick").dataset.held = String(now.deadman && obeyed());
  knob(-now.turn, -now.drive);
  return { ...now, drive: now.drive * share("forward") * allowed(), turn: now.turn * share("turning") };
}

/** @returns {boolean} whether the robot does what this very page holds */
function obeyed() {
  return known.obeyed && known.holder === known.you;
}

/**
 * Show what is held, by whatever holds it.
 * @param {number} x -1 to 1, to the right
 * @param {number} y -1 to 1, down
 */
function knob(x, y) {
  if (x === known.x && y === known.y) return;
  [known.x, known.y] = [x, y];
  at("knob").style.setProperty("--x", String(x));
  at("knob").style.setProperty("--y", String(y));
}

/** @param {boolean} open */
function connected(open) {
  known.heard = 0;
  known.met = known.met || open;
  const why = known.met ? "is zteleop web still running?" : "open the address that zteleop web has printed last";
  if (open) look();
  else tell("away", "not connected", `looking for the server: ${why}`);
}

/**
 * @param {string} state
 * @param {string} word
 * @param {string} why
 */
function tell(state, word, why) {
  phone.feel(state, held.stick().deadman);
  at("state").dataset.state = state;
  show("state", word);
  show("why", why);
}

/** @param {import("./bus.js").Word} word */
function hear(word) {
  switch (word.is) {
    case "hello":
      known.you = word.you;
      known.robot = word.robot;
      show("robot", word.robot);
      document.title = `${word.robot} \u2013 zteleop`;
      break;
    case "heard":
      heard(word.topic, word.message);
      break;
    case "graph":
      topics.tell(word.topics);
      graph.tell(word.topics);
      break;
    case "robots":
      robots.show(at("room-robots"), word.robots, known.robot);
      break;
    case "parameters":
      parameters.tell(word.parameters);
      break;
    case "wheel":
      known.holder = word.holder;
      wheel(word.pages);
      break;
    case "seen":
      known.obeyed = word.obeyed;
      known.refused = word.refused;
      note(word.note, word.alarm);
      break;
    case "note":
      note(word.says, word.alarm);
      break;
  }
}

/**
 * @param {string} topic
 * @param {any} message
 */
function heard(topic, message) {
  plot.hear(topic, message);
  topics.hear(topic, message);
  if (topic === "odom") {
    view.move(message);
    show("moving", twisted(message.twist.twist));
  } else if (topic === "drive_status") status(message);
  else if (topic === "vehicle") vehicle(message);
  else if (topic === "scene") scene(message.data);
  else if (topic === "battery_state") battery(message);
  else if (topic === "hazard_detection") feel("dangers", body.dangers(message));
  else if (topic === "interface_buttons") feel("buttons", body.buttons(message));
  else if (topic === "log") log.hear(message);
}

/**
 * @param {string} what
 * @param {string} words
 */
function feel(what, words) {
  show(what, words);
  const row = at(what).parentElement;
  if (row) row.hidden = false;
}

/** Say how old commands are when the robot hears them, there and back, and how much of what it says comes here. */
function link() {
  const beats = Math.min(bus.takeBeats(), BEATS);
  const age = known.latency ? `${(1000 * known.latency).toFixed(0)} ms there and back; ` : "";
  show("link", known.heard ? `${age}${beats} of ${BEATS} beats a second` : "-");
}

/** @param {any} said zteleop_msgs/msg/DriveStatus */
function status(said) {
  known.heard = performance.now();
  const who = said.operator ? `${said.source} ${said.operator.slice(-4).padStart(4, "0")}` : "";
  const word = said.state === "driving" ? (obeyed() ? "driving, you operate" : `driving, ${who} operates`) : said.state;
  tell(said.state, word, disobeyed(said.state) || said.why);
  show("asked", twisted(said.wanted));
  show("allowed", twisted(said.applied) + (said.slowed ? `, at most ${said.max_speed.toFixed(2)} m/s: ${said.slowed}` : ""));
  show("out", said.pulses.map((/** @type {any} */ p) => `${p.name} ${p.duty_ticks} (${p.pulse_us.toFixed(0)} us)`).join(", ") || "-");
  known.latency = said.latency;
  at("release").hidden = !said.stops.length;
  for (const pulse of said.pulses)
    if (pulse.name === "steering" && known.vehicle) view.wheels = pulse.fraction * known.vehicle.max_steering_angle;
}

/**
 * @param {string} state of the robot
 * @returns {string} why what this page holds moves nothing; nothing where it does, or the robot says why itself
 */
function disobeyed(state) {
  if (!held.stick().deadman || obeyed()) {
    known.since = performance.now();
    return "";
  }
  if (known.holder && known.holder !== known.you) return `you are not obeyed: ${known.holder} has the wheel`;
  if (known.refused) return `you are not obeyed: ${known.refused}`;
  const silent = state === "idle" && performance.now() - known.since > SOON;
  return silent ? "you are not obeyed: let go, and begin anew" : "";
}

/** @param {any} said zteleop_msgs/msg/Vehicle */
function vehicle(said) {
  known.vehicle = said;
  const steers = said.max_steering_angle > 0;
  const length = steers ? said.wheelbase : 0.34;
  view.vehicle = { steers, length, width: steers ? 0.68 * length : length };
  speeds();
}

/** @param {string} text the lines of a scene, as JSON */
function scene(text) {
  const lines = JSON.parse(text);
  view.scene = lines.map((/** @type {any} */ one) => ({ points: one.points, closed: false }));
  view.ask();
}

/** @param {any} said sensor_msgs/msg/BatteryState */
function battery(said) {
  const low = said.percentage < 0.2 ? ", low" : "";
  show("battery", `${Math.round(100 * said.percentage)} %${low}, ${said.voltage.toFixed(1)} V`);
}

/** @param {string[]} pages */
function wheel(pages) {
  const mine = known.holder === known.you;
  const who = mine ? "you have the wheel" : known.holder ? `${known.holder} has the wheel` : "nobody has the wheel";
  show("pages", pages.length > 1 ? `${who}, ${pages.length} pages are open` : who);
  at("take").toggleAttribute("disabled", mine);
  at("hand-over").toggleAttribute("disabled", !mine);
}

/**
 * @param {string} words
 * @param {boolean} alarm
 */
function note(words, alarm) {
  show("note", words);
  at("note").hidden = !words;
  at("note").dataset.alarm = String(alarm);
}

/**
 * @param {string} id of a slider
 * @returns {number} how much of what the robot may a full stick asks for
 */
function share(id) {
  return Number(/** @type {HTMLInputElement} */ (at(id)).value) / 100;
}

/** @returns {number} how much of the speed that the robot can it may drive now: a slider ends there */
function allowed() {
  const { max_speed, allowed_speed } = known.vehicle || { max_speed: 0, allowed_speed: 0 };
  return max_speed > 0 ? Math.min(1, allowed_speed / max_speed) : 1;
}

/** Say beside the sliders what a full stick asks for. */
function speeds() {
  if (!known.vehicle) return;
  show("forward-says", `${(share("forward") * allowed() * known.vehicle.max_speed).toFixed(2)} m/s`);
  show("turning-says", `${(share("turning") * known.vehicle.max_turn).toFixed(2)} rad/s`);
}

for (const id of ["forward", "turning"]) at(id).addEventListener("input", speeds);
at("stop").addEventListener("click", () => bus.wish("stop"));
at("release").addEventListener("click", () => bus.wish("release"));
at("take").addEventListener("click", () => bus.wish("take"));
at("hand-over").addEventListener("click", () => bus.wish("hand over"));
at("plot-save").addEventListener("click", () => save("zteleop.csv", plot.csv()));
touch(at("stick"), held);
tilt(at("tilt"), held);
setInterval(link, 1000);
setInterval(() => {
  if (known.heard && performance.now() - known.heard > SILENT) {
    known.heard = 0;
    tell("away", "the robot is not heard", "is its actuator on? If it moves, cut its power");
  }
}, 100);
