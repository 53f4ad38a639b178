'use strict';
// Forces of the fluid on one body, and of contacts and joints, as arrows at its centre of mass.

const FORCE_COLOURS = {
  pressure: '#1f6feb', friction: '#0b7285', buoyancy: '#2b8a3e', waves: '#5c7cfa', wind: '#868e96',
  added_mass: '#9c36b5', constraints: '#c92a2a',
};

class ForceArrows {
  // `forces`: names of the parts, and three numbers [N] for each part and sample of the motion.
  constructor(forces) {
    this.parts = forces.parts;
    this.samples = forces.samples;
    this.group = new THREE.Group();
    this.arrows = this.parts.map((part) => this.makeArrow(FORCE_COLOURS[part]));
    this.group.visible = false;
    this.metresPerNewton = 0;
  }

  makeArrow(colour) {
    const arrow = new THREE.ArrowHelper(new THREE.Vector3(0, 1, 0), new THREE.Vector3(), 1, colour);
    for (const part of [arrow.line, arrow.cone]) {
      // Seen through the body that they act on.
      Object.assign(part.material, { depthTest: false, transparent: true });
      part.renderOrder = JOINTS;
    }
    this.group.add(arrow);
    return arrow;
  }

  force(sample, part) {
    return new THREE.Vector3().fromArray(this.samples, 3 * (sample * this.parts.length + part));
  }

  // The largest force of the run [N].
  largest() {
    let most = 0;
    for (let i = 0; i < this.samples.length; i += 3) most = Math.max(most, Math.hypot(...this.samples.subarray(i, i + 3)));
    return most;
  }

  moveTo(motion, time) {
    const sample = motion.indexBefore(time);
    this.group.position.copy(motion.position);
    this.arrows.forEach((arrow, part) => {
      const force = this.force(sample, part);
      const length = this.metresPerNewton * force.length();
      arrow.visible = length > 0;
      if (!arrow.visible) return;
      arrow.setDirection(force.normalize());
      arrow.setLength(length, 0.2 * length, 0.1 * length);
    });
  }
}
