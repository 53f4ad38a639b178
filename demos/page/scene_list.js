'use strict';
// The scenes by name, and the description of the chosen one.

const element = (id) => document.getElementById(id);
const words = (name) => name.replace(/_/g, ' ');

class SceneList {
  // `choose`: called with the index of a run that was clicked on.
  constructor(runs, choose) {
    this.runs = runs;
    element('scenes').replaceChildren(...runs.map((run, i) => {
      const button = document.createElement('button');
      button.textContent = words(run.name);
      button.setAttribute('role', 'option');
      button.addEventListener('click', () => {
        button.blur();  // the space bar plays from now on
        choose(i);
      });
      return button;
    }));
  }

  // Index of the run that the address names, else the first.
  wanted() { return Math.max(this.runs.findIndex((run) => `#${run.name}` === location.hash), 0); }

  show(index) {
    const run = this.runs[index];
    [...element('scenes').children].forEach((button, i) => button.setAttribute('aria-selected', i === index));
    history.replaceState(null, '', `#${run.name}`);
    element('title').textContent = words(run.name);
    element('description').textContent = run.description;
  }
}
