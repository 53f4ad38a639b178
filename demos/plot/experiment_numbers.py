"""The numbers of docs/experiments.md, from the logs of a run of all scenes."""

import numpy as np
from runs import Run


def degrees(cosine):
    return np.degrees(np.arccos(np.clip(cosine, -1, 1)))


def late_half(track, until=None):
    """Rows of the second half of the motion, up to a time."""
    end = track.time[-1] if until is None else until
    return (track.time >= end / 2) & (track.time <= end)


def tilts(track):
    """Angle between the shape's z axis, whichever way, and the vertical, per row."""
    return degrees(np.abs(track.rotations()[:, 2, 2]))


class Numbers:
    def __init__(self, out):
        self.out = out
        self.read = {}

    def run(self, scene, model="ambient"):
        name = scene if model == "ambient" else f"{scene}-{model}"
        if name not in self.read:
            self.read[name] = Run(self.out / name)
        return self.read[name]

    def track(self, scene, model="ambient"):
        """The first body that moves."""
        return self.moving(scene, model)[0]

    def moving(self, scene, model="ambient"):
        return [track for track in self.run(scene, model).tracks if track.entry["mass"] > 0]

    def landing(self, track):
        return track.entry["path"]["landing"]

    def carry(self, scene, model="ambient"):
        return self.landing(self.track(scene, model))["position"][0]

    def throw(self, scene):
        landing = self.landing(self.track(scene))
        return landing["position"][0], landing["time"]

    def drift_at(self, distance, model="ambient"):
        """Sideways position of the free kick at a distance, or at the end if it does not get there."""
        position = self.track("soccer_curl", model).position
        return np.interp(distance, position[:, 0], position[:, 1])

    def drops(self):
        return [self.landing(track)["position"][0] for track in self.run("basketball_drop").tracks[1:]]

    def axis_angle(self, scene):
        track = self.track(scene)
        axis = track.rotations()[:, :, 0]
        cosine = (axis * track.velocity).sum(axis=1) / np.linalg.norm(track.velocity, axis=1)
        return degrees(cosine)[late_half(track, self.landing(track)["time"])].max()

    def fall(self, scene, model="ambient"):
        return self.track(scene, model).entry["fall"]

    def late_tilts(self, names):
        for track in self.run("plate_mass_sweep").tracks:
            if track.name in names:
                yield track.name, tilts(track)[track.time >= track.time[-1] - 0.5].max()

    def lags(self, names):
        """How far plates are behind free fall after one second [m]."""
        for track in self.run("plate_mass_sweep").tracks:
            if track.name in names:
                yield track.name, 9.81 / 2 + np.interp(1, track.time, track.position[:, 2])

    def turns_back(self):
        spin = self.track("underwater_ellipsoid").spin[:, 1]
        return int((spin[1:] * spin[:-1] < 0).sum())

    def end_speed(self, scene):
        return max(np.linalg.norm(track.velocity[-1]) for track in self.moving(scene))

    def largest_speed(self, scene):
        return max(track.entry["path"]["largest_speed"] for track in self.moving(scene))

    def largest_spin(self, scene):
        return np.linalg.norm(self.track(scene).spin, axis=1).max()

    def height(self, scene, model="ambient"):
        return self.track(scene, model).position[:, 2].max()

    def largest_tilt(self, scene):
        return degrees(self.track(scene).rotations()[:, 2, 2]).max()

    def end_tilt(self, scene):
        return max(tilts(track)[-1] for track in self.moving(scene))

    def catch(self, scene):
        """Distance and time at which a body comes down to the height of its launch."""
        track = self.track(scene)
        falling = np.flatnonzero((track.velocity[:, 2] < 0) & (track.position[:, 2] >= track.position[0, 2]))[-1]
        rows = slice(falling, falling + 2)
        height = -track.position[rows, 2]
        place, time = (np.interp(-track.position[0, 2], height, x) for x in (track.position[rows, 0], track.time[rows]))
        return place, time

    def late_spin(self, scene):
        """Mean spin about the vertical, either way, late half."""
        track = self.track(scene)
        return abs(track.spin[late_half(track), 2].mean())

    def late_descent(self, scene):
        track = self.track(scene)
        return -track.velocity[late_half(track), 2].mean()

    def copter(self, scene="paper_copter"):
        """Largest angle of the axis to the descent and mean spin about it, late half."""
        track = self.track(scene)
        rows = late_half(track)
        axis = track.rotations()[rows, :, 2]
        velocity = track.velocity[rows]
        cosine = -(axis * velocity).sum(axis=1) / np.linalg.norm(velocity, axis=1)
        return degrees(cosine).max(), np.abs((axis * track.spin[rows]).sum(axis=1)).mean()

    def shifts(self, scene):
        return [np.linalg.norm(track.position - track.position[0], axis=1).max() for track in self.moving(scene)]

    def largest_shift(self, scene):
        return max(self.shifts(scene))

    def least_shift(self, scene):
        return min(self.shifts(scene))

    def flap_angles(self):
        """Mean angles of the flaps from hanging, late half."""
        for track in self.moving("flap_in_current"):
            upward = track.rotations()[late_half(track), :, 2].mean(axis=0)
            yield np.degrees(np.arctan2(-upward[0], upward[2]))
