// @ts-check
/** What is said on the bus: each topic with its rate, and one of them value by value, as it comes. */

import { fields, number, rate, typed, worded } from "./fields.js";

const SHOWN_EVERY = 200; // ms
/** @typedef {{name: string, types: string[], said_by: string[], heard_by: string[], hz: number}} Topic */

export class Topics {
  /**
   * @param {HTMLElement} list
   * @param {HTMLElement} echo
   * @param {import("./plot.js").Plot} plot
   * @param {() => void} changed another topic is looked at
   */
  constructor(list, echo, plot, changed) {
    this.list = list;
    this.echo = echo;
    this.plot = plot;
    this.changed = changed;
    this.chosen = "";
    /** @type {Map<string, string[]>} */
    this.types = new Map();
    /** @type {any} */
    this.newest = null;
    /** @type {Map<string, {button: HTMLElement, rate: HTMLElement}>} */
    this.rows = new Map();
    /** @type {Map<string, {value: HTMLElement, box: HTMLInputElement | null}>} */
    this.cells = new Map();
    setInterval(() => this.show(), SHOWN_EVERY);
  }

  /** @param {Topic[]} topics */
  tell(topics) {
    const names = topics.map((topic) => topic.name);
    if (names.join() !== [...this.rows.keys()].join()) this.build(names);
    this.types = new Map(topics.map((topic) => [topic.name, topic.types]));
    for (const { name, types, hz, said_by: saidBy } of topics) {
      const row = this.rows.get(name);
      if (!row) continue;
      row.rate.textContent = rate(hz);
      row.button.title = `${types.join(", ") || "any type"}, said by ${[...new Set(saidBy)].join(", ") || "nobody"}`;
    }
  }

  /** @param {string[]} names */
  build(names) {
    this.rows.clear();
    this.list.replaceChildren(
      ...names.map((name) => {
        const button = document.createElement("button");
        const rate = document.createElement("span");
        button.append(name, rate);
        button.addEventListener("click", () => this.choose(name));
        button.setAttribute("aria-pressed", String(name === this.chosen));
        this.rows.set(name, { button, rate });
        return button;
      }),
    );
  }

  /** @param {string} name */
  choose(name) {
    this.chosen = name;
    this.newest = null;
    this.cells.clear();
    const waits = document.createElement("p");
    const pictures = (this.types.get(name) || []).some((type) => type.endsWith("Image"));
    waits.textContent = pictures ? `${name}: pictures are shown beside the robot from above` : `${name}: waits for what is said next`;
    this.echo.replaceChildren(waits);
    for (const [other, { button }] of this.rows) button.setAttribute("aria-pressed", String(other === name));
    this.changed();
  }

  /**
   * @param {string} topic with the source behind it, where it is one of commands
   * @param {any} message
   */
  hear(topic, message) {
    if (this.chosen && (topic === this.chosen || topic.startsWith(`${this.chosen}/`))) this.newest = message;
  }

  /** Show the newest message; of one that is made as the last was only what has changed. */
  show() {
    if (!this.newest || !this.echo.offsetParent) return;
    const found = [...fields(this.newest)];
    const names = found.map(([way]) => typed(way));
    if (names.join() !== [...this.cells.keys()].join()) this.lay(found);
    found.forEach(([, value], at) => {
      const cell = this.cells.get(names[at]);
      const text = worded(value);
      if (cell && cell.value.textContent !== text) cell.value.textContent = text;
    });
  }

  /** @param {[import("./fields.js").Way, any][]} found */
  lay(found) {
    this.cells.clear();
    const table = document.createElement("table");
    for (const [way] of found) {
      const row = table.insertRow();
      const name = typed(way);
      const head = document.createElement("th");
      head.scope = "row";
      let box = null;
      if (number(this.newest, way) !== null) {
        box = document.createElement("input");
        box.type = "checkbox";
        box.checked = this.plot.has(this.chosen, way);
        const [topic, ticked] = [this.chosen, box];
        box.addEventListener("change", () => (ticked.checked = this.plot.toggle(topic, way)));
        const label = document.createElement("label");
        label.append(box, name);
        head.append(label);
      } else head.append(name);
      row.append(head);
      this.cells.set(name, { value: row.insertCell(), box });
    }
    this.echo.replaceChildren(table);
  }

  /** Take in that a line of the plot is gone, or has come. */
  tick() {
    for (const [name, { box }] of this.cells) if (box) box.checked = this.plot.hasNamed(this.chosen, name);
  }
}
