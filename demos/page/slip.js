'use strict';
// Slip velocity of the fluid on every face of a body.

class SlipField {
  // The slip matrix, docs/theory.md eq. (12): three rows per face, U = -(I - n n^T) (-[c]x, I), and below them the row
  // of the normal velocity n . u, for the relative twist (w, v) in the body's axes.
  constructor(vertices, triangles) {
    this.faces = triangles.length / 3;
    this.rows = new Float32Array(24 * this.faces);
    const corners = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Vector3()];
    for (let face = 0; face < this.faces; ++face) {
      corners.forEach((corner, k) => corner.fromArray(vertices, 3 * triangles[3 * face + k]));
      const [a, b, c] = corners;
      const centroid = a.clone().add(b).add(c).divideScalar(3);
      const normal = b.clone().sub(a).cross(c.clone().sub(a)).normalize();
      this.setFace(face, normal.toArray(), centroid);
    }
  }

  setFace(face, normal, c) {
    // Rows of (-[c]x, I): velocity of the centroid for a twist.
    const velocity = [[0, c.z, -c.y, 1, 0, 0], [-c.z, 0, c.x, 0, 1, 0], [c.y, -c.x, 0, 0, 0, 1]];
    for (let k = 0; k < 6; ++k) {
      const along = normal.reduce((sum, n, i) => sum + n * velocity[i][k], 0);
      for (let i = 0; i < 3; ++i) this.rows[24 * face + 6 * i + k] = normal[i] * along - velocity[i][k];
      this.rows[24 * face + 18 + k] = along;
    }
  }

  product(row, twist) {
    let sum = 0;
    for (let k = 0; k < 6; ++k) sum += this.rows[6 * row + k] * twist[k];
    return sum;
  }

  speed(face, twist) {
    const row = 4 * face;
    return Math.hypot(this.product(row, twist), this.product(row + 1, twist), this.product(row + 2, twist));
  }

  // docs/theory.md eq. (13)
  isAttached(face, twist, slip, separationAngle) {
    const normalSpeed = this.product(4 * face + 3, twist);
    return normalSpeed > Math.hypot(normalSpeed, slip) * Math.cos(separationAngle);
  }
}

// Twist of a body relative to the medium, in the body's axes.
function relativeTwist(motion, mediumVelocity) {
  const toBody = motion.orientation.clone().conjugate();
  const spin = motion.spin.clone().applyQuaternion(toBody);
  const velocity = motion.velocity.clone().sub(mediumVelocity).applyQuaternion(toBody);
  return [spin.x, spin.y, spin.z, velocity.x, velocity.y, velocity.z];
}

// Dark blue over green to yellow, of rising lightness.
const COLOURS = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129],
  [92, 200, 99], [170, 220, 50], [253, 231, 37]];
const SEPARATED = [0.62, 0.64, 0.66];

// Red, green and blue in [0, 1] of a share in [0, 1].
function colourOf(share) {
  const place = Math.min(Math.max(share, 0), 1) * (COLOURS.length - 1);
  const i = Math.min(Math.floor(place), COLOURS.length - 2);
  return COLOURS[i].map((low, k) => (low + (place - i) * (COLOURS[i + 1][k] - low)) / 255);
}

function colourGradient() {
  return `linear-gradient(to right, ${COLOURS.map((colour) => `rgb(${colour})`).join(', ')})`;
}

// The least of these digits times a power of ten that is not below `value`; 1 for 0.
function roundUp(value, choices = [1, 2, 5, 10]) {
  if (!(value > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(value));
  return choices.find((digit) => digit * power >= value * (1 - 1e-6)) * power;
}
