// @ts-check
/** The nodes' parameters: a slider where there are bounds, a switch, a choice or a field where there are not. */

import { worded } from "./fields.js";

/**
 * @typedef {object} Tuned
 * @property {string} node
 * @property {string} name
 * @property {string} type
 * @property {any} value
 * @property {string} says
 * @property {number | null} least
 * @property {number | null} most
 * @property {string[]} choices
 * @property {boolean} read_only
 */
/** @typedef {{show: (value: any) => void, input: HTMLElement}} Control */

export class Parameters {
  /**
   * @param {HTMLElement} place
   * @param {(node: string, name: string, value: any) => void} set
   */
  constructor(place, set) {
    this.place = place;
    this.set = set;
    this.made = "";
    /** @type {Map<string, Control>} */
    this.controls = new Map();
  }

  /** @param {Tuned[]} parameters */
  tell(parameters) {
    const made = JSON.stringify(parameters.map(({ value: _, ...about }) => about));
    if (made !== this.made) this.build(parameters);
    this.made = made;
    for (const { node, name, value } of parameters) {
      const control = this.controls.get(`${node} ${name}`);
      if (control && !control.input.matches(":active, input[type=text]:focus")) control.show(value);
    }
  }

  /** @param {Tuned[]} parameters */
  build(parameters) {
    this.controls.clear();
    const nodes = [...new Set(parameters.map((one) => one.node))];
    this.place.replaceChildren(
      ...nodes.map((node) => {
        const group = document.createElement("fieldset");
        const title = document.createElement("legend");
        title.textContent = node;
        group.append(title, ...parameters.filter((one) => one.node === node).map((one) => this.row(one)));
        return group;
      }),
    );
  }

  /** @param {Tuned} one */
  row(one) {
    const label = document.createElement("label");
    const name = document.createElement("span");
    name.textContent = one.name;
    label.title = one.says;
    const output = document.createElement("output");
    const control = made(one, output, (value) => this.set(one.node, one.name, value));
    label.htmlFor = control.input.id = `${one.node}/${one.name}`; // else it would be the output's
    control.input.toggleAttribute("disabled", one.read_only || one.type.includes("array"));
    this.controls.set(`${one.node} ${one.name}`, control);
    const says = document.createElement("small");
    says.textContent = one.says;
    label.append(name, output, control.input, says);
    return label;
  }
}

/**
 * @param {Tuned} one
 * @param {HTMLElement} output what a slider stands at
 * @param {(value: any) => void} set
 * @returns {Control}
 */
function made(one, output, set) {
  if (one.choices.length) {
    const input = document.createElement("select");
    input.append(...one.choices.map((choice) => new Option(choice)));
    input.addEventListener("change", () => set(input.value));
    return { input, show: (value) => (input.value = value) };
  }
  const input = document.createElement("input");
  if (one.type === "boolean") {
    input.type = "checkbox";
    input.addEventListener("change", () => set(input.checked));
    return { input, show: (value) => (input.checked = value) };
  }
  if (one.least !== null && one.most !== null) {
    input.type = "range";
    Object.assign(input, { min: String(one.least), max: String(one.most), step: String(one.type === "integer" ? 1 : step(one.most - one.least)) });
    input.addEventListener("input", () => (output.textContent = worded(Number(input.value))));
    input.addEventListener("change", () => set(Number(input.value)));
    const show = (/** @type {number} */ value) => {
      input.value = String(value);
      output.textContent = worded(value);
    };
    return { input, show };
  }
  input.type = "text";
  const numeric = one.type === "double" || one.type === "integer";
  input.inputMode = numeric ? "decimal" : "text";
  input.addEventListener("change", () => set(numeric && input.value.trim() && !isNaN(Number(input.value)) ? Number(input.value) : input.value));
  return { input, show: (value) => (input.value = typeof value === "object" ? JSON.stringify(value) : worded(value)) };
}

/**
 * @param {number} reach
 * @returns {number} a round part of it: a hundredth, or somewhat less
 */
export function step(reach) {
  return reach > 0 ? 10 ** Math.floor(Math.log10(reach / 100)) : 1;
}
