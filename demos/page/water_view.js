'use strict';
// The surface of the water of a run: a translucent net that moves with its waves, y up.

const WATER_CELLS = 48;

class WaterView {
  // `viewed`: turns a vector of the run into the axes of the picture.
  constructor(water, box, viewed) {
    this.water = water;
    this.waves = water.waves.map((wave) => ({ ...wave, direction: viewed(new THREE.Vector3().fromArray(wave.direction)) }));
    this.current = viewed(new THREE.Vector3().fromArray(water.current));
    const [low, high] = this.extent(box, viewed);
    const size = high.clone().sub(low);
    this.geometry = new THREE.PlaneBufferGeometry(size.x, size.z, WATER_CELLS, WATER_CELLS);
    this.geometry.rotateX(-Math.PI / 2);
    this.geometry.translate((low.x + high.x) / 2, 0, (low.z + high.z) / 2);
    const material = new THREE.MeshLambertMaterial({ color: 0x2f7fb5, side: THREE.DoubleSide });
    Object.assign(material, { transparent: true, opacity: 0.35, depthWrite: false });
    this.mesh = new THREE.Mesh(this.geometry, material);
    this.moveTo(0);
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

  moveTo(time) {
    const places = this.geometry.attributes.position;
    for (let i = 0; i < places.count; ++i) places.setY(i, this.height(places.getX(i), places.getZ(i), time));
    places.needsUpdate = true;
    if (this.waves.length > 0) this.geometry.computeVertexNormals();
  }

  dispose() {
    this.geometry.dispose();
    this.mesh.material.dispose();
  }
}
