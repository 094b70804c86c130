// @ts-check
/** A phone that is tilted while a button is held: forward and back, left and right, from how it was held at first. */

const FULL = 30; // degrees for a full stick

/** @param {number} value */
const within = (value) => Math.max(-1, Math.min(1, value));

/**
 * @param {number} beta degrees, the top edge up
 * @param {number} gamma degrees, the left edge up
 * @param {number} angle degrees by which the screen is turned
 * @returns {[number, number]} the same of the screen as it is looked at
 */
export function seen(beta, gamma, angle) {
  if (angle === 90) return [-gamma, beta];
  if (angle === 270) return [gamma, -beta];
  return angle === 180 ? [-beta, -gamma] : [beta, gamma];
}

/**
 * Let a held button make a stick of the phone; it stays hidden where nothing tells how that lies.
 * @param {HTMLElement} button
 * @param {import("./held.js").Held} held
 */
export function tilt(button, held) {
  const tells = "DeviceOrientationEvent" in window && isSecureContext && matchMedia("(pointer: coarse)").matches;
  button.hidden = !tells;
  if (!tells) return;
  /** @type {[number, number] | null} */
  let first = null;
  /** @param {DeviceOrientationEvent} event */
  const read = (event) => {
    if (event.beta === null || event.gamma === null || !held.finger) return;
    const [fore, side] = seen(event.beta, event.gamma, screen.orientation ? screen.orientation.angle : 0);
    first = first || [fore, side];
    held.finger = { drive: within((first[0] - fore) / FULL), turn: within((first[1] - side) / FULL) };
  };
  button.addEventListener("pointerdown", (event) => {
    button.setPointerCapture(event.pointerId);
    first = null;
    held.finger = { drive: 0, turn: 0 };
    held.changed();
    addEventListener("deviceorientation", read);
    const asks = /** @type {any} */ (DeviceOrientationEvent).requestPermission; // of an iPhone, once
    if (asks) asks.call(DeviceOrientationEvent).catch(() => held.drop());
    event.preventDefault();
  });
  for (const end of ["pointerup", "pointercancel", "lostpointercapture"])
    button.addEventListener(end, () => {
      removeEventListener("deviceorientation", read);
      held.finger = null;
      held.changed();
    });
}
