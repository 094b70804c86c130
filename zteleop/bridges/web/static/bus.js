// @ts-check
/** One connection to the server: what is heard on the bus, and what is held on this page. */

export const PROTOCOL = "zteleop.v1";
const HELD_EVERY = 20; // ms
const LAST_WORDS = 3; // how often it is said that nothing is held any more
const FULL = 4096; // bytes on their way, beyond which older states would only come late
const AGAIN_AFTER = 1000; // ms

/**
 * @typedef {{drive: number, turn: number, deadman: boolean}} Stick
 * @typedef {{is: string, [field: string]: any}} Word
 */

export class Bus {
  /**
   * @param {string} token
   * @param {() => Stick} held what is held at this moment
   * @param {(word: Word) => void} hear what the server says
   * @param {(picture: ArrayBuffer) => void} see a picture of the camera
   * @param {(open: boolean) => void} changed the connection is there, or is not any more
   */
  constructor(token, held, hear, see, changed) {
    this.token = token;
    this.held = held;
    this.hear = hear;
    this.see = see;
    this.changed = changed;
    /** @type {WebSocket | null} */
    this.socket = null;
    /** @type {string[]} */
    this.topics = ["beat"];
    this.beat = { epoch: 0, time: 0 };
    this.beats = 0;
    this.seq = 0;
    this.last = 0;
    setInterval(() => this.sayHeld(), HELD_EVERY);
    this.connect();
  }

  connect() {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    const socket = new WebSocket(`${scheme}://${location.host}/bus`, [PROTOCOL, `token.${this.token}`]);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.socket = socket;
      this.changed(true);
      this.say({ is: "watch", topics: this.topics });
    };
    socket.onclose = () => {
      this.socket = null;
      this.changed(false);
      setTimeout(() => this.connect(), AGAIN_AFTER);
    };
    socket.onmessage = (event) => {
      if (typeof event.data === "string") this.take(JSON.parse(event.data));
      else this.see(event.data);
    };
  }

  /** @param {Word} word */
  take(word) {
    if (word.is === "heard" && word.topic === "beat") {
      this.beat = word.message;
      this.beats += 1;
    }
    this.hear(word);
  }

  /** @returns {number} how many beats were heard since this was asked last */
  takeBeats() {
    const beats = this.beats;
    this.beats = 0;
    return beats;
  }

  /** @param {string[]} topics all that is to be heard from now on; the beat always is */
  watch(topics) {
    this.topics = [...new Set(["beat", ...topics])];
    this.say({ is: "watch", topics: this.topics });
  }

  /** @param {Word} word */
  say(word) {
    if (this.socket && this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(word));
  }

  /** @param {string} of stop, release, take or hand over */
  wish(of, why = "") {
    this.say({ is: "wish", of, why });
  }

  /** Say all that is held: a state and no change of one, so that nothing that gets lost is missed. */
  sayHeld() {
    const stick = this.held();
    if (!this.socket || this.socket.bufferedAmount > FULL) return;
    this.last = stick.deadman ? LAST_WORDS : Math.max(this.last - 1, -1);
    if (this.last < 0) return;
    this.seq += 1;
    const { epoch, time } = this.beat;
    this.say({ is: "held", seq: this.seq, ...stick, epoch, beat: time });
  }
}
