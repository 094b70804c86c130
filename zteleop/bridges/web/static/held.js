// @ts-check
/** What is held: keys by where they lie, a finger on the stick, a gamepad. */

const KEYS = /** @type {Record<string, [number, number]>} */ ({
  ArrowUp: [1, 0],
  KeyW: [1, 0],
  ArrowDown: [-1, 0],
  KeyS: [-1, 0],
  ArrowLeft: [0, 1],
  KeyA: [0, 1],
  ArrowRight: [0, -1],
  KeyD: [0, -1],
});
const DEAD_ZONE = 0.12; // of a pad's axes, which rest near 0 and not at it
const DEADMAN = [4, 5, 6, 7]; // a pad's shoulder buttons: while one is held, its stick counts

/** @param {number} value */
const within = (value) => Math.max(-1, Math.min(1, value));

export class Held {
  /**
   * @param {Document} page
   * @param {() => void} changed something is held now that was not, or no longer: a moment in which nothing was must not be lost
   */
  constructor(page, changed) {
    this.changed = changed;
    /** @type {Set<string>} */
    this.keys = new Set();
    /** @type {{drive: number, turn: number} | null} */
    this.finger = null;
    page.addEventListener("keydown", (event) => this.press(event));
    page.addEventListener("keyup", (event) => this.keys.delete(event.code) && this.changed());
    for (const lost of ["blur", "pagehide"]) addEventListener(lost, () => this.drop());
    page.addEventListener("visibilitychange", () => page.hidden && this.drop());
  }

  /** @param {KeyboardEvent} event */
  press(event) {
    if (!(event.code in KEYS) || event.ctrlKey || event.altKey || event.metaKey || typing(event)) return;
    event.preventDefault();
    if (event.repeat) return; // a key that was held in another window begins nothing here
    this.keys.add(event.code);
    this.changed();
  }

  /** Nothing is held any more: what happens to keys elsewhere, this page does not hear. */
  drop() {
    this.keys.clear();
    this.finger = null;
    this.changed();
  }

  /** @returns {import("./bus.js").Stick} */
  stick() {
    if (this.finger) return { ...this.finger, deadman: true };
    if (this.keys.size) {
      let [drive, turn] = [0, 0];
      for (const key of this.keys) {
        drive += KEYS[key][0];
        turn += KEYS[key][1];
      }
      return { drive: within(drive), turn: within(turn), deadman: true };
    }
    return padded(navigator.getGamepads ? navigator.getGamepads() : []) || { drive: 0, turn: 0, deadman: false };
  }
}

/**
 * @param {KeyboardEvent} event
 * @returns {boolean} whether whatever has the focus takes this key itself: a slider the arrows, a switch none of these
 */
function typing(event) {
  const target = /** @type {HTMLElement | null} */ (event.target);
  if (!target || !target.closest("input, select, textarea")) return false;
  if (target.matches("[type=checkbox]")) return false;
  return !target.matches("[type=range]") || event.code.startsWith("Arrow");
}

/**
 * @param {readonly (Gamepad | null)[]} pads
 * @returns {import("./bus.js").Stick | null} of the first whose dead-man is held
 */
export function padded(pads) {
  for (const pad of pads) {
    if (!pad || !DEADMAN.some((button) => pad.buttons[button] && pad.buttons[button].pressed)) continue;
    const [turn, drive] = [-pad.axes[0], -pad.axes[1]].map((axis) => (Math.abs(axis) < DEAD_ZONE ? 0 : axis));
    return { drive: within(drive), turn: within(turn), deadman: true };
  }
  return null;
}

/**
 * Let a finger hold the stick: from where it lands, as far as it goes.
 * @param {HTMLElement} pad
 * @param {Held} held
 */
export function touch(pad, held) {
  let [x, y] = [0, 0];
  pad.addEventListener("pointerdown", (event) => {
    pad.setPointerCapture(event.pointerId);
    [x, y] = [event.clientX, event.clientY];
    held.finger = { drive: 0, turn: 0 };
    held.changed();
    event.preventDefault();
  });
  pad.addEventListener("pointermove", (event) => {
    if (!held.finger) return;
    const reach = pad.clientWidth / 2;
    const [right, down] = [within((event.clientX - x) / reach), within((event.clientY - y) / reach)];
    held.finger = { drive: -down, turn: -right };
  });
  for (const end of ["pointerup", "pointercancel", "lostpointercapture"])
    pad.addEventListener(end, () => {
      held.finger = null;
      held.changed();
    });
}
