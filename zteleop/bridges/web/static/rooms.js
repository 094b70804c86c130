// @ts-check
/** Rooms of which one is shown at a time, and the tabs that lead there. */

export class Rooms {
  /**
   * @param {HTMLElement} list with a tab for each room
   * @param {(room: string) => void} entered
   */
  constructor(list, entered) {
    this.entered = entered;
    this.tabs = /** @type {HTMLElement[]} */ ([...list.querySelectorAll("[role=tab]")]);
    for (const tab of this.tabs) tab.addEventListener("click", () => this.enter(tab.id.replace("tab-", "")));
  }

  /** @param {string} room */
  enter(room) {
    for (const tab of this.tabs) {
      const shown = tab.id === `tab-${room}`;
      tab.setAttribute("aria-selected", String(shown));
      const place = document.getElementById(tab.getAttribute("aria-controls") || "");
      if (place) place.hidden = !shown;
    }
    this.entered(room);
  }
}
