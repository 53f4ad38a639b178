'use strict';
// The direction of a uniform flow: an arrow at one place of the picture, in front of everything.

class FlowArrow {
  constructor() {
    const material = new THREE.MeshLambertMaterial({ color: 0x0b8299 });
    const shaft = new THREE.CylinderBufferGeometry(0.025, 0.025, 0.7, 16).translate(0, -0.15, 0);
    const head = new THREE.ConeBufferGeometry(0.09, 0.3, 24).translate(0, 0.35, 0);
    this.arrow = new THREE.Group();
    this.arrow.add(new THREE.Mesh(shaft, material), new THREE.Mesh(head, material));
    this.scene = new THREE.Scene();
    this.scene.add(this.arrow, new THREE.HemisphereLight(0xffffff, 0x8894a0, 1));
  }

  // `velocity` with y up.
  show(velocity) {
    this.arrow.visible = velocity.length() > 0;
    if (!this.arrow.visible) return;
    this.arrow.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), velocity.clone().normalize());
  }

  // Over a picture of `camera`, as far away as `target`: at the left, below the middle.
  render(renderer, camera, target) {
    if (!this.arrow.visible) return;
    const depth = target.clone().project(camera).z;
    this.arrow.position.set(-0.72, -0.5, depth).unproject(camera);
    this.arrow.scale.setScalar(0.13 * camera.position.distanceTo(target));
    renderer.clearDepth();
    renderer.render(this.scene, camera);
  }
}
