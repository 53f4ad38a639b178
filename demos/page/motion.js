'use strict';
// Motion of one body between the samples of its trajectory.

// Numbers per sample: time, position, orientation (w, x, y, z), angular velocity, velocity; world axes.
const SAMPLE_SIZE = 14;

class Motion {
  constructor(samples) {
    this.samples = samples;
    this.count = samples.length / SAMPLE_SIZE;
    this.position = new THREE.Vector3();
    this.orientation = new THREE.Quaternion();
    this.spin = new THREE.Vector3();
    this.velocity = new THREE.Vector3();
  }

  vector(sample, column, into = new THREE.Vector3()) {
    return into.fromArray(this.samples, sample * SAMPLE_SIZE + column);
  }

  positionOf(sample) { return this.vector(sample, 1); }

  orientationOf(sample) {
    const at = sample * SAMPLE_SIZE + 4;
    const [w, x, y, z] = this.samples.subarray(at, at + 4);
    return new THREE.Quaternion(x, y, z, w).normalize();
  }

  timeOf(sample) { return this.samples[sample * SAMPLE_SIZE]; }

  // The last sample that is not later than `time`, and not the very last.
  indexBefore(time) {
    let low = 0, high = this.count - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (this.timeOf(middle) <= time) low = middle; else high = middle;
    }
    return low;
  }

  // Sets position, orientation, spin and velocity: cubic in the position and in the angle about the axis of the turn
  // between the samples, linear in the velocities.
  moveTo(time) {
    const i = this.indexBefore(time);
    const j = Math.min(i + 1, this.count - 1);
    const step = this.timeOf(j) - this.timeOf(i);
    const s = step > 0 ? Math.min(Math.max((time - this.timeOf(i)) / step, 0), 1) : 0;
    const spins = [this.vector(i, 8), this.vector(j, 8)];
    const velocities = [this.vector(i, 11), this.vector(j, 11)];
    this.spin.lerpVectors(spins[0], spins[1], s);
    this.velocity.lerpVectors(velocities[0], velocities[1], s);
    const t = 1 - s;
    // Weights of the values and of the rates at both ends.
    const from = (1 + 2 * s) * t * t, to = s * s * (3 - 2 * s);
    const fromRate = s * t * t * step, toRate = -s * s * t * step;
    this.position.set(0, 0, 0)
      .addScaledVector(this.positionOf(i), from)
      .addScaledVector(velocities[0], fromRate)
      .addScaledVector(this.positionOf(j), to)
      .addScaledVector(velocities[1], toRate);
    const turn = turnBetween(this.orientationOf(i), this.orientationOf(j),
      spins[0].clone().add(spins[1]).multiplyScalar(step / 2));
    const whole = turn.length();
    this.orientation.copy(this.orientationOf(i));
    if (whole > 0) {
      const axis = turn.divideScalar(whole);
      const angle = fromRate * axis.dot(spins[0]) + to * whole + toRate * axis.dot(spins[1]);
      this.orientation.premultiply(new THREE.Quaternion().setFromAxisAngle(axis, angle));
    }
  }
}

// Rotation vector in world axes that leads from one orientation to the other: of all numbers of full turns, the one
// nearest to the turn that the angular velocity lets expect. A ball may spin more than half a turn between samples.
function turnBetween(from, to, expected) {
  const q = to.clone().multiply(from.clone().conjugate());
  const axis = new THREE.Vector3(q.x, q.y, q.z);
  const sine = axis.length();
  if (sine < 1e-7) {
    const turns = Math.round(expected.length() / (2 * Math.PI));
    return turns === 0 ? new THREE.Vector3() : expected.clone().normalize().multiplyScalar(2 * Math.PI * turns);
  }
  axis.divideScalar(sine);
  const angle = 2 * Math.atan2(sine, q.w);
  const turns = Math.round((expected.dot(axis) - angle) / (2 * Math.PI));
  return axis.multiplyScalar(angle + 2 * Math.PI * turns);
}
