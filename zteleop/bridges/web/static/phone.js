// @ts-check
/** What a phone does for who holds it: the screen stays on while he drives, and he feels what ends it. */

const FELT = [200, 100, 200]; // ms on, off, on
const ENDS = ["stopped", "fault", "link lost", "operator idle", "away"]; // states in which what is held moves nothing

export class Phone {
  constructor() {
    /** @type {any} */
    this.lock = null;
    this.state = "";
  }

  /** Keep the screen on from now on; it goes off again with the page. */
  async stayAwake() {
    const { wakeLock } = /** @type {any} */ (navigator);
    if (!wakeLock || this.lock) return;
    this.lock = true;
    try {
      this.lock = await wakeLock.request("screen");
      this.lock.addEventListener("release", () => (this.lock = null));
    } catch {
      this.lock = null; // a hidden page, or an empty battery: the next press asks again
    }
  }

  /**
   * Shake where driving has ended, and not because nobody held anything.
   * @param {string} state
   * @param {boolean} holds
   */
  feel(state, holds) {
    const ended = holds && this.state === "driving" && ENDS.includes(state);
    this.state = state;
    if (ended && navigator.vibrate) navigator.vibrate(FELT);
  }
}
