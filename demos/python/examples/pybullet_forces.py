#!/usr/bin/python3
"""A fluid around a body of PyBullet, by forces alone: see the limits in docs/python.md.

    from pybullet_forces import FluidForces
    fluid = FluidForces(pybullet, body, fluid_body, mass, inertia, ba.water())
    while True:
        fluid.apply()
        pybullet.stepSimulation()

The body has no joints and no damping (changeDynamics(body, -1, linearDamping=0, angularDamping=0)). Its inertial frame is
the frame F of the fluid body: axes of the mesh, origin at the centre of mass.
"""

import numpy as np

import bullet_ambient as ba


def rotation(x, y, z, w):
    """Rotation matrix of a unit quaternion in PyBullet's order x, y, z, w."""
    r = np.array([x, y, z])
    return (w * w - r @ r) * np.eye(3) + 2 * np.outer(r, r) + 2 * w * np.cross(np.eye(3), r)


class FluidForces:
    def __init__(self, client, body, fluid_body, mass, inertia, medium, flow=ba.FlowSettings(), gravity=(0, 0, -9.81)):
        self.client, self.body, self.fluid_body, self.medium = client, body, fluid_body, medium
        self.loads = fluid_body.loads_in(medium, flow)
        self.mass, self.inertia, self.gravity = mass, np.asarray(inertia), np.asarray(gravity)
        self.dry = np.block([[self.inertia, np.zeros((3, 3))], [np.zeros((3, 3)), mass * np.eye(3)]])
        self.wet = self.dry + medium.density * fluid_body.added_mass

    def apply(self):
        """Adds the force and the torque that give the dry body the acceleration of the wet one, for the next step."""
        position, quaternion = self.client.getBasePositionAndOrientation(self.body)
        axes = rotation(*quaternion)  # of the body, as columns in the world
        linear, angular = (np.asarray(v) @ axes for v in self.client.getBaseVelocity(self.body))
        gravity, buoyancy = self.gravity @ axes, -self.medium.density * self.fluid_body.volume * self.gravity @ axes
        wrench = self.loads(np.r_[angular, linear - self.medium.velocity @ axes])
        wrench += np.r_[np.cross(self.fluid_body.centre_of_volume, buoyancy), self.mass * gravity + buoyancy]
        momentum = self.dry @ np.r_[angular, linear]
        momentum += (self.wet - self.dry) @ np.r_[angular, linear - self.medium.velocity @ axes]
        spin, push = momentum[:3], momentum[3:]
        wrench += np.r_[np.cross(spin, angular) + np.cross(push, linear), np.cross(push, angular)]  # Kirchhoff's equations
        acceleration = np.linalg.solve(self.wet, wrench)
        torque = self.inertia @ acceleration[:3] + np.cross(angular, self.inertia @ angular)  # without the gyroscopic torque that Bullet adds
        force = self.mass * (acceleration[3:] + np.cross(angular, linear) - gravity)
        self.client.applyExternalForce(self.body, -1, axes @ force, position, self.client.WORLD_FRAME)
        self.client.applyExternalTorque(self.body, -1, axes @ torque, self.client.WORLD_FRAME)
