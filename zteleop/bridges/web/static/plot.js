// @ts-check
/** Numbers over time: lines that are picked from what is said, on two axes, with a file of all that is shown. */

import { number, typed, worded } from "./fields.js";

const SPAN = 60; // s that are shown, and kept
const MOST = 8; // lines
const DRAWN_EVERY = 50; // ms
const COLOURS = ["#3d8fe0", "#d98a1f", "#2fa37c", "#c2549f", "#8f7ae6", "#b5a321", "#de5f4f", "#6f95a0"];
const HIGH = 220; // px

/**
 * @typedef {object} Line
 * @property {string} topic
 * @property {import("./fields.js").Way} way
 * @property {string} name
 * @property {string} colour
 * @property {"left" | "right"} axis
 * @property {number[]} x s since the page was loaded
 * @property {number[]} y
 * @property {HTMLElement} says its newest value
 */

export class Plot {
  /**
   * @param {HTMLElement} place for the picture
   * @param {HTMLElement} legend
   * @param {HTMLElement} pause a button
   * @param {() => void} changed other topics are wanted than before
   */
  constructor(place, legend, pause, changed) {
    this.place = place;
    this.legend = legend;
    this.pause = pause;
    this.changed = changed;
    /** @type {Line[]} */
    this.lines = [];
    /** @type {any} */
    this.picture = null;
    this.paused = false;
    this.fresh = false;
    setInterval(() => this.draw(), DRAWN_EVERY);
    new ResizeObserver(() => this.picture && this.picture.setSize(this.size())).observe(place);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.build());
    pause.addEventListener("click", () => this.hold(!this.paused));
  }

  /** @returns {string[]} what must be watched */
  get topics() {
    return this.lines.map((line) => line.topic);
  }

  /**
   * @param {string} topic
   * @param {import("./fields.js").Way} way
   */
  has(topic, way) {
    return this.hasNamed(topic, typed(way));
  }

  /**
   * @param {string} topic
   * @param {string} name
   */
  hasNamed(topic, name) {
    return this.lines.some((line) => line.topic === topic && line.name === name);
  }

  /**
   * Add a line, or take it away.
   * @param {string} topic
   * @param {import("./fields.js").Way} way
   * @returns {boolean} whether it is there now
   */
  toggle(topic, way) {
    const name = typed(way);
    if (this.has(topic, way)) this.lines = this.lines.filter((line) => line.topic !== topic || line.name !== name);
    else if (this.lines.length < MOST) {
      const colour = COLOURS.find((one) => this.lines.every((line) => line.colour !== one)) || COLOURS[0];
      this.lines.push({ topic, way, name, colour, axis: "left", x: [], y: [], says: document.createElement("output") });
    }
    this.build();
    this.changed();
    return this.has(topic, way);
  }

  /**
   * @param {string} topic with the source behind it, where it is one of commands
   * @param {any} message
   */
  hear(topic, message) {
    const now = performance.now() / 1000;
    for (const line of this.lines) {
      if (topic !== line.topic && !topic.startsWith(`${line.topic}/`)) continue;
      const value = number(message, line.way);
      if (value === null) continue;
      line.x.push(now);
      line.y.push(value);
      const old = line.x.findIndex((x) => x > now - 2 * SPAN);
      if (old > 200) {
        line.x.splice(0, old);
        line.y.splice(0, old);
      }
      this.fresh = true;
    }
  }

  /** @param {boolean} paused what is shown stays as it is, and can be looked at closely */
  hold(paused) {
    this.paused = paused;
    this.pause.textContent = paused ? "go on" : "pause";
    this.pause.setAttribute("aria-pressed", String(paused));
    this.fresh = true;
  }

  size() {
    return { width: Math.max(this.place.clientWidth, 200), height: HIGH };
  }

  /** Begin the picture anew: other lines, other axes, other colours. */
  build() {
    this.list();
    if (this.picture) this.picture.destroy();
    this.picture = null;
    this.place.hidden = !this.lines.length;
    if (!this.lines.length) return;
    const style = getComputedStyle(this.place);
    const [ink, hair] = [style.getPropertyValue("--faint").trim(), style.getPropertyValue("--line").trim()];
    const grid = { stroke: hair, width: 1 };
    const sides = [...new Set(this.lines.map((line) => line.axis))];
    const x = { stroke: ink, grid, ticks: grid, values: (/** @type {any} */ _, /** @type {number[]} */ at) => at.map((s) => `${worded(s)} s`) };
    const options = {
      ...this.size(),
      legend: { show: false },
      cursor: { points: { size: 7 } },
      scales: { x: { time: false } },
      axes: [x, ...sides.map((side) => ({ scale: side, side: side === "left" ? 3 : 1, stroke: ink, ticks: grid, grid: side === "left" || sides.length === 1 ? grid : { show: false } }))],
      series: [{}, ...this.lines.map((line) => ({ scale: line.axis, stroke: line.colour, width: 2, spanGaps: true, points: { show: false } }))],
      hooks: {
        setSelect: [(/** @type {any} */ picture) => picture.select.width > 0 && this.hold(true)],
        setCursor: [(/** @type {any} */ picture) => this.read(picture.cursor.idx)],
      },
    };
    this.picture = new /** @type {any} */ (window).uPlot(options, this.table(performance.now() / 1000), this.place);
    this.fresh = true;
  }

  /**
   * @param {number} [origin] s that count as 0
   * @returns {(number | null)[][]} the times of all lines, and then the values of each
   */
  table(origin = 0) {
    const tables = this.lines.map((line) => [line.x.map((x) => x - origin), line.y]);
    return tables.length ? /** @type {any} */ (window).uPlot.join(tables) : [[]];
  }

  draw() {
    if (!this.picture || this.paused || !this.fresh || !this.place.offsetParent) return;
    this.fresh = false;
    const now = performance.now() / 1000;
    this.picture.batch(() => {
      this.picture.setData(this.table(now), false);
      for (const side of new Set(this.lines.map((line) => line.axis))) this.picture.setScale(side, this.range(side, now));
      this.picture.setScale("x", { min: -SPAN, max: 0 });
    });
    if (this.picture.cursor.idx === null || this.picture.cursor.left < 0) this.read(null);
  }

  /**
   * @param {string} side
   * @param {number} now
   * @returns {{min: number, max: number}} what its lines reached lately, and some room around it
   */
  range(side, now) {
    let [min, max] = [Infinity, -Infinity];
    for (const line of this.lines) {
      if (line.axis !== side) continue;
      line.y.forEach((value, at) => {
        if (line.x[at] < now - SPAN) return;
        min = Math.min(min, value);
        max = Math.max(max, value);
      });
    }
    if (min > max) return { min: 0, max: 1 };
    const room = max > min ? 0.08 * (max - min) : Math.abs(max) * 0.1 || 1;
    return { min: min - room, max: max + room };
  }

  /** @param {number | null | undefined} at which time the pointer is over; else the newest is told */
  read(at) {
    this.lines.forEach((line, number) => {
      const column = this.picture && this.picture.data[number + 1];
      let value = at === null || at === undefined ? line.y[line.y.length - 1] : column && column[at];
      for (let before = at || 0; before > 0 && (value === null || value === undefined); before -= 1) value = column && column[before - 1];
      line.says.textContent = value === null || value === undefined ? "-" : worded(value);
    });
  }

  /** Write the lines below the picture: which is which, and what can be done with it. */
  list() {
    this.legend.replaceChildren(
      ...this.lines.map((line) => {
        const item = document.createElement("li");
        const swatch = document.createElement("i");
        swatch.style.background = line.colour;
        const name = document.createElement("span");
        name.textContent = `${line.topic} ${line.name}`;
        const axis = document.createElement("button");
        axis.textContent = `${line.axis} axis`;
        axis.addEventListener("click", () => {
          line.axis = line.axis === "left" ? "right" : "left";
          this.build();
        });
        const away = document.createElement("button");
        away.textContent = "\u00d7";
        away.setAttribute("aria-label", `${name.textContent}: no longer`);
        away.addEventListener("click", () => this.toggle(line.topic, line.way));
        item.append(swatch, name, line.says, axis, away);
        return item;
      }),
    );
  }

  /** @returns {string} all that is kept, a row for each time */
  csv() {
    const [times, ...columns] = this.table();
    const head = ["time_s", ...this.lines.map((line) => `${line.topic} ${line.name}`)].join(",");
    const rows = times.map((time, at) => [time && time.toFixed(3), ...columns.map((column) => column[at] ?? "")].join(","));
    return `${[head, ...rows].join("\n")}\n`;
  }
}

/**
 * Keep a text as a file of the browser's.
 * @param {string} name
 * @param {string} text
 */
export function save(name, text) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type: "text/csv" }));
  link.download = name;
  link.click();
  URL.revokeObjectURL(link.href);
}
