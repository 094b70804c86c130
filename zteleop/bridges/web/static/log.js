// @ts-check
/** What the robot's nodes say in words, the newest first. */

const MOST = 200; // lines that are kept
const LEVELS = /** @type {Record<number, string>} */ ({ 10: "debug", 20: "info", 30: "warns", 40: "error", 50: "fatal" });
const WARNS = 30;

export class Log {
  /**
   * @param {HTMLElement} place a table's body
   * @param {HTMLInputElement} filter whether only warnings are shown
   */
  constructor(place, filter) {
    this.place = place;
    filter.addEventListener("change", () => place.toggleAttribute("data-warnings", filter.checked));
  }

  /** @param {any} said rcl_interfaces/msg/Log */
  hear(said) {
    const row = document.createElement("tr");
    row.dataset.level = said.level >= WARNS ? "warns" : "info";
    const time = new Date(1000 * said.stamp.sec).toLocaleTimeString();
    for (const text of [time, said.name, LEVELS[said.level] || String(said.level), said.msg]) {
      const cell = document.createElement("td");
      cell.textContent = text;
      row.append(cell);
    }
    this.place.prepend(row);
    while (this.place.children.length > MOST) this.place.lastElementChild?.remove();
  }
}
