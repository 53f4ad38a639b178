'use strict';
// What is drawn of one body: its faces in the colours of the slip, and its path.

const PATH_COLOURS = ['#1f6feb', '#d9480f', '#2b8a3e', '#9c36b5', '#c2255c', '#5c7cfa', '#e8a400', '#0b7285'];
// Pieces of the path's line between two samples.
const PATH_PIECES = 4;
// Bodies of this library are drawn after those of rivals, which would else cover them where they start.
// Water is drawn after bodies, so that it tints what is below its surface; that in holds before the sea, which leaves them out.
const OWN_FACES = 1, OWN_EDGES = 2, HOLD_WATER = 3, WATER_MASK = 4, WATER_FACES = 5, WATER_NET = 6, JOINTS = 7;
const WALL_OPACITY = 0.25;
const RIVAL_COLOURS = { vacuum: '#495057', uwrbd: '#d6336c', gwtf: '#e8590c' };

class BodyView {
  // `colour`: of the path, and of the body itself if `isRival`. `inPool`: static bodies are the walls of a pool, through
  // which one sees. `shapes`: of all bodies and holds.
  constructor(body, shapes, colour, isRival, inPool) {
    const shape = shapes[body.shape];
    this.body = body;
    this.motion = new Motion(body.samples);
    this.isStatic = body.mass === 0;
    this.group = new THREE.Group();
    this.geometry = makeGeometry(shape);
    this.slip = this.isStatic || isRival ? null : new SlipField(shape.vertices, shape.triangles);
    this.isWall = this.isStatic && inPool;
    this.mesh = new THREE.Mesh(this.geometry, this.makeMaterial(colour, isRival));
    this.edges = new THREE.LineSegments(makeEdges(shape),
      new THREE.LineBasicMaterial({ color: 0x223344, transparent: true, opacity: isRival ? 0.25 : 0.5 }));
    if (!isRival && !this.isWall) {
      this.mesh.renderOrder = OWN_FACES;
      this.edges.renderOrder = OWN_EDGES;
    }
    this.solid = new THREE.Group();
    this.solid.add(this.mesh, this.edges);
    this.group.add(this.solid);
    this.forces = body.forces && !isRival ? new ForceArrows(body.forces) : null;
    if (this.forces) this.group.add(this.forces.group);
    this.holds = isRival ? [] : (body.holds || []).map(
      (hold) => new HoldView(shapes[hold.shape], hold.samples, this.solid));
    for (const hold of this.holds) this.group.add(hold.group);
    if (!this.isStatic) this.group.add(makePath(this.motion, colour));
  }

  makeMaterial(colour, isRival) {
    // Behind its edges. Sheets have the triangles of both sides.
    const common = { flatShading: true, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 };
    if (isRival) {
      return new THREE.MeshLambertMaterial(
        { ...common, color: colour, transparent: true, opacity: 0.35, depthWrite: false });
    }
    if (this.isWall) {
      return new THREE.MeshLambertMaterial(
        { ...common, color: 0xb4c0cb, transparent: true, opacity: WALL_OPACITY, depthWrite: false });
    }
    if (this.isStatic) return new THREE.MeshLambertMaterial({ ...common, color: 0xd3dae1 });
    // Opaque; only what is transparent is drawn after the rivals.
    return new THREE.MeshLambertMaterial({ ...common, vertexColors: THREE.VertexColors, transparent: true });
  }

  moveTo(time, magnification) {
    this.motion.moveTo(time);
    this.solid.position.copy(this.motion.position);
    this.solid.quaternion.copy(this.motion.orientation);
    this.solid.scale.setScalar(this.isStatic ? 1 : magnification);
    if (this.forces) this.forces.moveTo(this.motion, time);
  }

  // Moves the water in the holds; see HoldView.moveTo().
  moveHolds(time, toView, seaBelow) {
    for (const hold of this.holds) hold.moveTo(this.motion, time, toView, seaBelow);
  }

  // Colours the faces; this.largest is the largest slip now [m/s].
  colour(mediumVelocity, scale, showSeparation) {
    this.largest = 0;
    if (!this.slip) return;
    const twist = relativeTwist(this.motion, mediumVelocity);
    const colours = this.geometry.attributes.color;
    for (let face = 0; face < this.slip.faces; ++face) {
      const speed = this.slip.speed(face, twist);
      this.largest = Math.max(this.largest, speed);
      const attached = !showSeparation || this.slip.isAttached(face, twist, speed, this.body.separation_angle);
      const [red, green, blue] = attached ? colourOf(speed / scale) : SEPARATED;
      for (let corner = 3 * face; corner < 3 * face + 3; ++corner) colours.setXYZ(corner, red, green, blue);
    }
    colours.needsUpdate = true;
  }

  // Largest slip over the run, looked up at some of its samples [m/s].
  largestSlip(mediumVelocity) {
    if (!this.slip) return 0;
    let largest = 0;
    const stride = Math.max(1, Math.floor(this.motion.count / 60));
    for (let sample = 0; sample < this.motion.count; sample += stride) {
      this.motion.moveTo(this.motion.timeOf(sample));
      const twist = relativeTwist(this.motion, mediumVelocity);
      for (let face = 0; face < this.slip.faces; ++face) largest = Math.max(largest, this.slip.speed(face, twist));
    }
    return largest;
  }

  // The box that the body sweeps, in the axes that `toView` leads to.
  swept(toView) {
    const box = new THREE.Box3();
    const radius = this.radius();
    for (let i = 0; i < this.motion.count; ++i) {
      const place = this.motion.positionOf(i).applyQuaternion(toView);
      box.expandByPoint(place.clone().addScalar(radius)).expandByPoint(place.addScalar(-radius));
    }
    return box;
  }

  radius() {
    this.geometry.computeBoundingSphere();
    return this.geometry.boundingSphere.center.length() + this.geometry.boundingSphere.radius;
  }

  dispose() {
    this.group.traverse((part) => {
      if (part.geometry) part.geometry.dispose();
      if (part.material) part.material.dispose();
    });
  }
}

// Three vertices of its own per face, so that each face has one colour.
function makeGeometry(shape) {
  const positions = new Float32Array(3 * shape.triangles.length);
  shape.triangles.forEach((vertex, i) => positions.set(shape.vertices.subarray(3 * vertex, 3 * vertex + 3), 3 * i));
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
  geometry.setAttribute('color', new THREE.BufferAttribute(new Float32Array(positions.length).fill(0.7), 3));
  geometry.computeVertexNormals();
  return geometry;
}

// Where faces meet at more than 25 degrees, and rims of sheets.
function makeEdges(shape) {
  const side = shape.sheet ? shape.triangles.subarray(0, shape.triangles.length / 2) : shape.triangles;
  return new THREE.EdgesGeometry(makeGeometry({ ...shape, triangles: side }), 25);
}

// A line through the samples with dots at even intervals of time.
function makePath(motion, colour) {
  const points = [];
  for (let k = 0; k <= (motion.count - 1) * PATH_PIECES; ++k) {
    const sample = Math.min(Math.floor(k / PATH_PIECES), motion.count - 2);
    const share = k / PATH_PIECES - sample;
    motion.moveTo((1 - share) * motion.timeOf(sample) + share * motion.timeOf(sample + 1));
    points.push(motion.position.clone());
  }
  const path = new THREE.Group();
  const asGeometry = (places) => new THREE.BufferGeometry().setFromPoints(places);
  path.add(new THREE.Line(asGeometry(points), new THREE.LineBasicMaterial({ color: colour })));
  const end = motion.timeOf(motion.count - 1);
  const interval = roundUp(end / 20);
  const dots = [];
  for (let k = 0; k * interval <= end * (1 + 1e-6); ++k) {
    motion.moveTo(k * interval);
    dots.push(motion.position.clone());
  }
  path.add(new THREE.Points(asGeometry(dots),
    new THREE.PointsMaterial({ color: colour, size: 5, sizeAttenuation: false })));
  return path;
}
