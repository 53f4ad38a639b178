'use strict';
// The surface of the water of a run, y up: a translucent sheet, lighter at crests and darker in troughs, under a net.

// Cells along a side of the sheet: as many as the shortest wave asks for, within these.
const LEAST_CELLS = 48, MOST_CELLS = 160, CELLS_PER_WAVE = 12;
// Every so many cells has a line of the net.
const NET_STRIDE = 4;
const TROUGH = new THREE.Color(0x1b5a8a), CREST = new THREE.Color(0x9fd3ee);

class WaterView {
  // `viewed`: turns a vector of the run into the axes of the picture.
  constructor(water, box, viewed) {
    this.water = water;
    this.waves = water.waves.map((wave) => ({ ...wave, direction: viewed(new THREE.Vector3().fromArray(wave.direction)) }));
    this.current = viewed(new THREE.Vector3().fromArray(water.current));
    this.reach = this.waves.reduce((sum, wave) => sum + wave.amplitude, 0);
    const [low, high] = this.extent(box, viewed);
    this.makeGeometry(low, high, this.cells(high.clone().sub(low)));
    // Not where holds are.
    const look = { transparent: true, depthWrite: false, stencilWrite: true, stencilRef: 0, stencilFunc: THREE.EqualStencilFunc };
    this.mesh = new THREE.Mesh(this.geometry, new THREE.MeshLambertMaterial(
      { ...look, vertexColors: THREE.VertexColors, side: THREE.DoubleSide, opacity: 0.55 }));
    this.net = new THREE.LineSegments(this.netGeometry, new THREE.LineBasicMaterial(
      { ...look, color: 0x0d3f66, opacity: 0.35 }));
    this.mesh.renderOrder = WATER_FACES;
    this.net.renderOrder = WATER_NET;
    this.group = new THREE.Group();
    this.group.add(this.mesh, this.net);
    this.moveTo(0);
  }

  cells(size) {
    const largest = Math.max(0, ...this.waves.map((wave) => wave.wave_number));
    const wanted = CELLS_PER_WAVE * Math.max(size.x, size.z) * largest / (2 * Math.PI);
    return NET_STRIDE * Math.round(Math.min(Math.max(wanted, LEAST_CELLS), MOST_CELLS) / NET_STRIDE);
  }

  // The sheet, and the net over its vertices.
  makeGeometry(low, high, cells) {
    this.geometry = new THREE.PlaneBufferGeometry(high.x - low.x, high.z - low.z, cells, cells);
    this.geometry.rotateX(-Math.PI / 2);
    this.geometry.translate((low.x + high.x) / 2, 0, (low.z + high.z) / 2);
    const places = this.geometry.attributes.position;
    this.geometry.setAttribute('color', new THREE.BufferAttribute(new Float32Array(3 * places.count), 3));
    const lines = [];
    for (let line = 0; line <= cells; line += NET_STRIDE) {
      for (let k = 0; k < cells; ++k) {
        const row = line * (cells + 1) + k, column = k * (cells + 1) + line;
        lines.push(row, row + 1, column, column + cells + 1);
      }
    }
    this.netGeometry = new THREE.BufferGeometry();
    this.netGeometry.setAttribute('position', places);
    this.netGeometry.setIndex(lines);
  }

  // The bounds of a pool; of a sea, what is looked at and half as much around it.
  extent(box, viewed) {
    const margin = 0.5 * box.getSize(new THREE.Vector3()).length();
    const looked = box.clone().expandByScalar(margin);
    if (!this.water.bounds) return [looked.min, looked.max];
    const corner = (ends, open) => ends.map((end, i) => (end === null ? open[i] : end));
    const far = 1e6;
    const bounds = new THREE.Box3().setFromPoints([
      viewed(new THREE.Vector3().fromArray(corner(this.water.bounds.lowest, [-far, -far, -far]))),
      viewed(new THREE.Vector3().fromArray(corner(this.water.bounds.highest, [far, far, far]))),
    ]).intersect(looked);
    return [bounds.min, bounds.max];
  }

  height(x, z, time) {
    let height = this.water.level;
    for (const wave of this.waves) {
      const along = wave.direction.x * (x - this.current.x * time) + wave.direction.z * (z - this.current.z * time);
      height += wave.amplitude * Math.cos(wave.wave_number * along - wave.frequency * time + wave.phase);
    }
    return height;
  }

  // The plane that touches the surface above a place; its normal points down, to what is kept below it.
  planeAt(place, time) {
    const at = (dx, dz) => new THREE.Vector3(place.x + dx, this.height(place.x + dx, place.z + dz, time), place.z + dz);
    const step = 0.01 * (this.waves.length > 0 ? 1 / Math.max(...this.waves.map((wave) => wave.wave_number)) : 1);
    return new THREE.Plane().setFromCoplanarPoints(at(0, 0), at(step, 0), at(0, step));
  }

  moveTo(time) {
    const places = this.geometry.attributes.position, colours = this.geometry.attributes.color;
    const colour = new THREE.Color();
    for (let i = 0; i < places.count; ++i) {
      const height = this.height(places.getX(i), places.getZ(i), time);
      const share = this.reach > 0 ? (height - this.water.level) / (2 * this.reach) : 0;
      colour.copy(TROUGH).lerp(CREST, Math.min(Math.max(0.5 + share, 0), 1));
      places.setY(i, height);
      colours.setXYZ(i, colour.r, colour.g, colour.b);
    }
    places.needsUpdate = true;
    colours.needsUpdate = true;
    if (this.waves.length > 0) this.geometry.computeVertexNormals();
  }

  dispose() {
    for (const part of [this.mesh, this.net]) {
      part.geometry.dispose();
      part.material.dispose();
    }
  }
}
