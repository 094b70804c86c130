// @ts-check
/** What the robot's camera sees, the newest only: of the pictures that come while one is decoded, the last. */

const STAMP = 8; // bytes before the picture: the time of day in s when it was taken
const GONE = 2000; // ms without a picture, after which none is shown
const RECENT = 20; // pictures that their number a second is counted by

export class Eye {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {(words: string) => void} tell how many pictures come, and how old they are
   */
  constructor(canvas, tell) {
    this.canvas = canvas;
    this.tell = tell;
    this.busy = false;
    /** @type {ArrayBuffer | null} */
    this.next = null;
    /** @type {number[]} */
    this.shown = [];
    setInterval(() => this.look(), GONE / 4);
  }

  /** @param {ArrayBuffer} frame */
  async see(frame) {
    this.next = frame;
    if (this.busy) return;
    this.busy = true;
    while (this.next) {
      const now = this.next;
      this.next = null;
      await this.show(now);
    }
    this.busy = false;
  }

  /** @param {ArrayBuffer} frame */
  async show(frame) {
    const taken = new DataView(frame).getFloat64(0);
    let picture;
    try {
      picture = await createImageBitmap(new Blob([new Uint8Array(frame, STAMP)]));
    } catch {
      return; // no picture: the next one may be
    }
    const { canvas } = this;
    if (canvas.width !== picture.width || canvas.height !== picture.height) {
      canvas.width = picture.width;
      canvas.height = picture.height;
    }
    const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
    pen.drawImage(picture, 0, 0);
    picture.close();
    canvas.hidden = false;
    const now = performance.now();
    this.shown = [...this.shown.slice(1 - RECENT), now];
    const pace = (1000 * (this.shown.length - 1)) / Math.max(now - this.shown[0], 1);
    const age = Math.max(0, Date.now() - 1000 * taken);
    this.tell(`${pace.toFixed(0)} a second, ${age.toFixed(0)} ms old`);
  }

  /** Take the last one away when no other has come: it is not what the robot sees. */
  look() {
    const last = this.shown[this.shown.length - 1] || -Infinity;
    if (this.canvas.hidden || performance.now() - last < GONE) return;
    this.canvas.hidden = true;
    this.shown = [];
    this.tell("no picture any more");
  }
}
