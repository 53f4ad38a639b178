'use strict';
// The page: choice of the scene, time, overlays and what they show.

const SPEEDS = [0.01, 0.03, 0.1, 0.25, 0.5, 1, 2, 4];
const MODELS = {
  vacuum: 'vacuum (stock Bullet)',
  uwrbd: 'Underwater Rigid Body Dynamics: linear drag',
  gwtf: 'stand-in for Going with the Flow: windward flux',
};

function decodeBase64(text, Type) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return new Type(bytes.buffer);
}

function readData() {
  const data = JSON.parse(element('runs').textContent);
  for (const shape of data.shapes) {
    shape.vertices = decodeBase64(shape.vertices, Float32Array);
    shape.triangles = decodeBase64(shape.triangles, Uint32Array);
  }
  for (const run of data.runs) {
    for (const bodies of [run.bodies, ...run.rivals.map((rival) => rival.bodies)]) {
      for (const body of bodies) {
        body.samples = decodeBase64(body.samples, Float32Array);
        for (const more of [...(body.forces ? [body.forces] : []), ...(body.holds || [])]) {
          more.samples = decodeBase64(more.samples, Float32Array);
        }
      }
    }
  }
  return data;
}

function digits(value, count = 3) {
  const rounded = Number(value.toPrecision(count));
  return rounded === 0 || Math.abs(rounded) >= 1e-3 ? rounded.toString() : rounded.toExponential();
}

class Player {
  constructor(data, view) {
    this.data = data;
    this.view = view;
    this.time = 0;
    this.playing = false;
    this.changed = true;
    this.lastFrame = null;
    this.scenes = new SceneList(data.runs, (i) => this.select(i));
    this.makeChoices();
    this.listen();
    this.select(this.scenes.wanted());
    requestAnimationFrame((now) => this.frame(now));
  }

  makeChoices() {
    for (const speed of SPEEDS) element('speed').append(new Option(`${speed} ×`, speed, speed === 1, speed === 1));
    element('legend-bar').style.background = colourGradient();
    element('force-colours').replaceChildren(...Object.entries(FORCE_COLOURS).map(([part, colour]) => {
      const name = document.createElement('span');
      name.style.color = colour;
      name.textContent = words(part);
      return name;
    }));
  }

  listen() {
    element('play').addEventListener('click', () => this.play(!this.playing));
    element('time').addEventListener('input', () => { this.play(false); this.setTime(Number(element('time').value)); });
    element('view').addEventListener('change', () => this.look());
    element('size').addEventListener('input', () => {
      this.setMagnification(this.largestMagnification ** element('size').value);
    });
    element('show-separation').addEventListener('change', (event) => {
      this.view.showSeparation = event.target.checked;
      this.changed = true;
    });
    element('show-forces').addEventListener('change', () => this.showForces());
    this.view.controls.addEventListener('change', () => { this.changed = true; });
    window.addEventListener('resize', () => { this.changed = true; });
    window.addEventListener('keydown', (event) => this.key(event));
  }

  key(event) {
    if (/^(INPUT|SELECT|BUTTON)$/.test(event.target.tagName)) return;
    const step = { ArrowLeft: -1 / 60, ArrowRight: 1 / 60 }[event.key];
    if (event.key === ' ') this.play(!this.playing);
    else if (step) { this.play(false); this.setTime(this.time + step); }
    else return;
    event.preventDefault();
  }

  select(index) {
    this.run = this.data.runs[index];
    this.scenes.show(index);
    this.view.followed = null;
    this.view.show(this.run, this.data.shapes);
    this.largestMagnification = Math.max(20, 3 * this.view.naturalMagnification);
    element('time').max = this.run.duration;
    element('legend-ticks').replaceChildren(...[0, 0.25, 0.5, 0.75, 1].map((share) => {
      const tick = document.createElement('span');
      tick.textContent = digits(share * this.view.slipScale);
      return tick;
    }));
    const flow = this.view.mediumVelocity.length();
    element('flow').hidden = flow === 0;
    element('flow').textContent = `flow of ${digits(flow)} m/s`;
    this.makeViewChoices();
    this.makeOverlays();
    element('forces').hidden = this.view.withForces().length === 0;
    this.showForces();
    this.setTime(0);
    this.look();
    this.play(false);
  }

  makeViewChoices() {
    const moving = this.view.moving();
    const choices = moving.map((view, i) => new Option(`follow ${words(view.body.name)}`, i));
    element('view').replaceChildren(new Option('whole path', -1), ...choices);
  }

  makeOverlays() {
    element('overlays').replaceChildren(...this.run.rivals.map((rival) => {
      const label = document.createElement('label');
      const box = document.createElement('input');
      box.type = 'checkbox';
      box.checked = true;
      box.id = `rival-${rival.model}`;
      box.addEventListener('change', () => {
        this.view.showRival(rival.model, box.checked);
        if (!this.view.followed) this.view.lookAt(null, this.time);
        this.setMagnification(this.view.magnification);
      });
      const mark = document.createElement('i');
      mark.style.background = RIVAL_COLOURS[rival.model];
      label.append(box, mark, MODELS[rival.model]);
      return label;
    }));
  }

  showForces() {
    const shown = element('show-forces').checked;
    this.view.showForces(shown);
    element('force-colours').hidden = !shown || element('forces').hidden;
    this.changed = true;
  }

  look() {
    const chosen = this.view.moving()[element('view').value];
    this.setMagnification(chosen ? 1 : this.view.naturalMagnification);
    this.view.render();
    this.view.lookAt(chosen || null, this.time);
    this.changed = true;
  }

  setMagnification(factor) {
    this.view.magnification = factor;
    element('size').value = Math.log(factor) / Math.log(this.largestMagnification);
    const shown = digits(factor, 2);
    element('factor').textContent = shown;
    const magnified = shown === '1' ? '' : ` · bodies drawn ${shown} times their size`;
    element('scale').textContent = `grid: ${digits(this.view.gridStep)} m${magnified}`;
    this.changed = true;
  }

  setTime(time) {
    this.time = Math.min(Math.max(time, 0), this.run.duration);
    element('time').value = this.time;
    this.changed = true;
  }

  play(playing) {
    if (playing && this.time >= this.run.duration) this.setTime(0);
    this.playing = playing;
    element('play').textContent = playing ? 'Pause' : 'Play';
  }

  frame(now) {
    if (this.playing && this.lastFrame !== null) {
      // A page that was hidden goes on where it stopped.
      const seconds = Math.min((now - this.lastFrame) / 1000, 0.1);
      this.setTime(this.time + Number(element('speed').value) * seconds);
      if (this.time >= this.run.duration) this.play(false);
    }
    this.lastFrame = now;
    if (this.changed) this.draw();
    requestAnimationFrame((next) => this.frame(next));
  }

  draw() {
    this.changed = false;
    this.view.moveTo(this.time);
    element('clock').textContent = `${this.time.toFixed(3)} / ${digits(this.run.duration)} s`;
    element('numbers').textContent = this.numbers();
    this.view.render();
  }

  // The body that is followed, else the first one that moves.
  numbers() {
    const moving = this.view.moving();
    if (moving.length === 0) return 'no body moves';
    const { body, motion, largest, holds } = this.view.followed || moving[0];
    const water = holds.map((hold) => `${digits(hold.volume)} m³`).join(', ');
    return `${words(body.name)}: speed ${digits(motion.velocity.length())} m/s`
      + ` · spin ${digits(motion.spin.length())} rad/s · largest slip ${digits(largest)} m/s`
      + (water ? ` · water inside ${water}` : '');
  }

  // Pose of a body of the shown run at the shown time, for tests: position [m], orientation x, y, z, w.
  pose(name) {
    const view = this.view.bodies.find((candidate) => candidate.body.name === name);
    view.motion.moveTo(this.time);
    return { position: view.motion.position.toArray(), orientation: view.motion.orientation.toArray() };
  }
}

function makeRenderer(canvas) {
  try {
    return new THREE.WebGLRenderer({ canvas, antialias: true, logarithmicDepthBuffer: true });
  } catch (error) {
    return null;
  }
}

function start() {
  const canvas = element('canvas');
  const data = readData();
  const renderer = makeRenderer(canvas);
  if (renderer) {
    window.player = new Player(data, new RunView(renderer, canvas));
    window.player.play(!matchMedia('(prefers-reduced-motion: reduce)').matches);
  } else {
    element('viewer').classList.add('without-picture');
    const scenes = new SceneList(data.runs, (i) => scenes.show(i));
    scenes.show(scenes.wanted());
  }
}

start();
