'use strict';
// One run in the 3D view: bodies, rivals, joints, ground grid and camera.

class RunView {
  constructor(renderer, canvas) {
    this.renderer = renderer;
    this.renderer.autoClear = false;
    this.renderer.localClippingEnabled = true;
    this.scene = new THREE.Scene();
    this.scene.background = new THREE.Color(0xeef2f6);
    this.camera = new THREE.PerspectiveCamera(35, 1, 0.01, 1000);
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.enableKeys = false;
    // Little shade: colours are to be compared with the legend.
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0xd8dde2, 0.82));
    const sun = new THREE.DirectionalLight(0xffffff, 0.22);
    sun.position.set(1, 3, 2);
    this.scene.add(sun);
    this.world = new THREE.Group();
    this.scene.add(this.world);
    this.flow = new FlowArrow();
    this.bodies = [];
    this.rivals = {};
    this.followed = null;
    this.water = null;
    this.magnification = 1;
    this.showSeparation = false;
  }

  show(run, shapes) {
    this.clear();
    this.run = run;
    this.mediumVelocity = new THREE.Vector3().fromArray(run.medium_velocity);
    // The camera has y up.
    const up = new THREE.Vector3().fromArray(run.gravity).multiplyScalar(-1);
    if (up.length() === 0) up.set(0, 0, 1);
    this.world.quaternion.setFromUnitVectors(up.normalize(), new THREE.Vector3(0, 1, 0));
    this.flow.show(this.viewed(this.mediumVelocity));
    const makeViews = (bodies, colour) => bodies.map((body, i) => {
      const pathColour = colour || PATH_COLOURS[i % PATH_COLOURS.length];
      const inPool = Boolean(run.water && run.water.bounds);
      const view = new BodyView(body, shapes, pathColour, Boolean(colour), inPool);
      this.world.add(view.group);
      return view;
    });
    this.bodies = makeViews(run.bodies, null);
    for (const rival of run.rivals) {
      this.rivals[rival.model] = makeViews(rival.bodies.filter((body) => body.mass > 0), RIVAL_COLOURS[rival.model]);
    }
    this.addJoints();
    const largest = Math.max(...this.bodies.map((view) => view.largestSlip(this.mediumVelocity)));
    this.slipScale = roundUp(largest, [1, 1.2, 1.6, 2, 2.4, 3.2, 4, 5, 6, 8, 10]);
    this.world.updateMatrixWorld();
    this.measure();
    this.frame();
    this.scaleForces();
    if (run.water) {
      this.water = new WaterView(run.water, this.box, (vector) => this.viewed(vector));
      this.scene.add(this.water.group);
    }
  }

  clear() {
    if (this.water) {
      this.scene.remove(this.water.group);
      this.water.dispose();
      this.water = null;
    }
    for (const view of this.allViews()) view.dispose();
    this.world.children.slice().forEach((child) => this.world.remove(child));
    this.bodies = [];
    this.rivals = {};
  }

  allViews() { return this.bodies.concat(...Object.values(this.rivals)); }

  moving() { return this.bodies.filter((view) => !view.isStatic); }

  // The moving bodies; all of them if none moves.
  subjects() { return this.moving().length > 0 ? this.moving() : this.bodies; }

  sweptBy(views) {
    return views.reduce((box, view) => box.union(view.swept(this.world.quaternion)), new THREE.Box3());
  }

  // The box that the bodies sweep, y up, and a magnification that keeps them visible in it.
  measure() {
    this.ownBox = this.sweptBy(this.subjects());
    const span = this.ownBox.getSize(new THREE.Vector3()).length();
    const wanted = 0.03 * span / Math.min(...this.subjects().map((view) => view.radius()));
    // Bodies that meet others, or water, keep their size.
    const canMeet = this.bodies.length > this.moving().length || this.run.joints.length > 0 || Boolean(this.run.water);
    this.naturalMagnification = canMeet ? 1 : Math.max(1, wanted);
  }

  // The box that is looked at: visible rivals are in it, unless they leave what this library's bodies sweep by more
  // than its size, as a plate that falls in a vacuum.
  frame() {
    const rivals = Object.values(this.rivals).flat().filter((view) => view.group.visible);
    const most = this.ownBox.clone().expandByScalar(this.ownBox.getSize(new THREE.Vector3()).length());
    this.box = this.sweptBy(rivals).intersect(most).union(this.ownBox);
    this.span = this.box.getSize(new THREE.Vector3()).length();
    this.makeGrid();
  }

  makeGrid() {
    if (this.grid) this.scene.remove(this.grid);
    const size = this.box.getSize(new THREE.Vector3());
    this.gridStep = roundUp(Math.max(size.x, size.z, this.span / 4) / 12);
    const cells = 2 * Math.ceil(Math.max(size.x, size.z, this.span / 4) / this.gridStep / 2 + 2);
    this.grid = new THREE.GridHelper(cells * this.gridStep, cells, 0x9aa8b5, 0xc6d0d9);
    const centre = this.box.getCenter(new THREE.Vector3());
    const onGrid = (x) => Math.round(x / this.gridStep) * this.gridStep;
    this.grid.position.set(onGrid(centre.x), this.groundHeight(), onGrid(centre.z));
    this.scene.add(this.grid);
  }

  // Of the lowest place that a body reaches, or of the floor under the bodies.
  groundHeight() {
    let height = this.box.min.y;
    if (this.moving().length === 0) return height;
    const lowest = Math.min(...this.moving().map((view) => this.lowestCentre(view)));
    for (const view of this.bodies.filter((candidate) => candidate.isStatic)) {
      view.moveTo(0, 1);
      view.group.updateMatrixWorld(true);
      const top = new THREE.Box3().setFromObject(view.mesh).max.y;
      if (top <= lowest) height = Math.max(height, top + 1e-3 * this.span);
    }
    return height;
  }

  lowestCentre(view) {
    const heights = Array.from({ length: view.motion.count },
      (_, i) => this.viewed(view.motion.positionOf(i)).y);
    return Math.min(...heights);
  }

  // A dot at each joint, fixed to its first body.
  addJoints() {
    for (const joint of this.run.joints) {
      const view = this.bodies.find((candidate) => candidate.body.name === joint.bodies[0]);
      view.motion.moveTo(0);
      const point = new THREE.Vector3().fromArray(joint.point).sub(view.motion.position)
        .applyQuaternion(view.motion.orientation.clone().conjugate());
      const material = new THREE.PointsMaterial({ color: 0xc92a2a, size: 7, sizeAttenuation: false });
      // Inside of bodies, and yet to be seen.
      Object.assign(material, { depthTest: false, transparent: true });
      const dot = new THREE.Points(new THREE.BufferGeometry().setFromPoints([point]), material);
      dot.renderOrder = JOINTS;
      view.solid.add(dot);
    }
  }

  // Looks at everything, or follows one body.
  lookAt(view, time) {
    this.followed = view;
    const direction = new THREE.Vector3(0.35, 0.28, 1).normalize();
    if (view) {
      this.moveTo(time);
      this.controls.target.copy(this.placeOf(view));
      this.setDistance(direction, 5.5 * view.radius() * this.magnification);
    } else {
      this.box.getCenter(this.controls.target);
      this.setDistance(this.broadside(), this.fittingDistance());
    }
    this.controls.update();
  }

  // A direction from which the flow, or else the path, goes across the picture.
  broadside() {
    const flow = this.viewed(this.mediumVelocity);
    const size = Math.hypot(flow.x, flow.z) > 0 ? flow : this.box.getSize(new THREE.Vector3());
    return Math.abs(size.x) >= Math.abs(size.z) ? new THREE.Vector3(0.3, 0.25, 1).normalize() : new THREE.Vector3(1, 0.25, 0.3).normalize();
  }

  fittingDistance() {
    const half = Math.tan(0.5 * this.camera.fov * Math.PI / 180);
    const size = this.box.getSize(new THREE.Vector3());
    const width = Math.max(size.x, size.z) + 0.3 * Math.min(size.x, size.z);
    const height = size.y + 0.25 * width;
    const far = 0.5 * Math.max(1.4 * height, 1.15 * width / this.camera.aspect) / half;
    return far + 0.5 * Math.min(size.x, size.z);
  }

  setDistance(direction, distance) {
    this.camera.position.copy(this.controls.target).addScaledVector(direction, distance);
  }

  // In the axes of the camera's scene.
  viewed(vector) { return vector.clone().applyQuaternion(this.world.quaternion); }

  placeOf(view) { return this.viewed(view.motion.position); }

  moveTo(time) {
    const before = this.followed && this.placeOf(this.followed);
    for (const view of this.allViews()) view.moveTo(time, this.magnification);
    if (this.water) this.water.moveTo(time);
    const seaBelow = this.water && ((place) => this.water.planeAt(place, time));
    for (const view of this.bodies) view.moveHolds(time, this.world.quaternion, seaBelow);
    if (this.followed) {
      const step = this.placeOf(this.followed).sub(before);
      this.controls.target.add(step);
      this.camera.position.add(step);
    }
    for (const view of this.bodies) view.colour(this.mediumVelocity, this.slipScale, this.showSeparation);
  }

  withForces() { return this.bodies.filter((view) => view.forces); }

  // The largest force of the run is an arrow of a third of what the bodies sweep, or of the size of the largest body.
  scaleForces() {
    const largest = Math.max(...this.withForces().map((view) => view.forces.largest()));
    const length = Math.max(this.span / 3, ...this.withForces().map((view) => 1.5 * view.radius()));
    for (const { forces } of this.withForces()) forces.metresPerNewton = largest > 0 ? length / largest : 0;
  }

  showForces(visible) {
    for (const { forces } of this.withForces()) forces.group.visible = visible;
  }

  showRival(model, visible) {
    for (const view of this.rivals[model]) view.group.visible = visible;
    this.frame();
  }

  render() {
    const canvas = this.renderer.domElement;
    const width = canvas.clientWidth, height = canvas.clientHeight;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    if (canvas.width !== Math.floor(width * ratio) || canvas.height !== Math.floor(height * ratio)) {
      this.renderer.setPixelRatio(ratio);
      this.renderer.setSize(width, height, false);
    }
    this.camera.aspect = width / height;
    const distance = this.camera.position.distanceTo(this.controls.target);
    this.camera.near = 0.01 * distance;
    this.camera.far = 10 * (distance + this.span);
    this.camera.updateProjectionMatrix();
    this.renderer.clear();
    this.renderer.render(this.scene, this.camera);
    this.flow.render(this.renderer, this.camera, this.controls.target);
  }
}
