"""Puts a fluid into the world of an unmodified PyBullet, 3.1.7 and later.

    import pybullet as p, bullet_ambient.pybullet
    p.connect(p.DIRECT)
    fluid = bullet_ambient.pybullet.Fluid()
    fluid.water(level=0)

All bodies of the world then float or sink in the water, also those that are added later. docs/pybullet.md describes it.
"""

import importlib
import json
import math
import tempfile
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple, Optional, Union

import numpy as np
import numpy.typing as npt

from bullet_ambient import FluidBody, _core

__all__ = ["Fluid", "Spectrum", "Wave", "plugin_path"]

_PIECE = 1000  # largest number of bytes sent at once; PyBullet takes at most 1023
_SPECTRUM = ("significant_height", "peak_period", "direction", "peak_enhancement", "components", "seed")  # of scenes
_OF_LINKS = ("fluid_body", "law", "medium", "roughness")  # attributes of <ambient>
_Vector = Sequence[float]
_Flows = Sequence[Mapping[str, Any]]


class Wave(NamedTuple):
    """A wave on deep water: amplitude [m], period [s], direction of propagation, phase at the origin at time 0 [rad]."""

    amplitude: float
    period: float
    direction: _Vector = (1, 0, 0)
    phase: float = 0


class Spectrum(NamedTuple):
    """A wind sea (JONSWAP): significant height [m], peak period [s], direction, peak enhancement, number of waves, seed."""

    height: float
    period: float
    direction: _Vector = (1, 0, 0)
    enhancement: float = 3.3
    components: int = 50
    seed: int = 1


def plugin_path() -> str:
    """Returns the path of the plugin's file, for `pybullet.loadPlugin(plugin_path(), "_ambient")`."""
    return str(Path(__file__).parent / "libbullet_ambient_pybullet.so")


def _corners(bounds: Optional[_Vector]) -> Optional[dict[str, Any]]:
    """Converts six numbers to the bounds of a scene; infinite ones are open."""
    if bounds is None:
        return None
    sides = [None if math.isinf(side) else float(side) for side in bounds]
    return {"lowest": sides[:3], "highest": sides[3:]}


class Fluid:
    """Fluid in the world of one PyBullet client.

    Bodies are in a fluid once a region is added. Regions and settings survive `resetSimulation`; numbers of bodies,
    saved states and the time start anew. Bad values raise ValueError with one line.
    """

    def __init__(self, client: int = 0) -> None:
        """Loads the plugin into the server of a client, `physicsClientId`.

        A server in another process loads the file from the same path. All Fluid objects of a client share one fluid.
        """
        self._bullet: Any = importlib.import_module("pybullet")
        self._client = client
        self._plugin: int = self._bullet.loadPlugin(plugin_path(), "_ambient", physicsClientId=client)
        if self._plugin < 0:
            raise OSError(f"{plugin_path()}: PyBullet could not load it; is the client connected?")

    def water(
        self,
        level: float = 0,
        *,
        density: Optional[float] = None,
        viscosity: Optional[float] = None,
        current: Optional[_Vector] = None,
        waves: Optional[Iterable[Wave]] = None,
        spectrum: Optional[Spectrum] = None,
        wind: Optional[_Vector] = None,
        flow: Optional[_Flows] = None,
        flow_above: Optional[_Flows] = None,
        layers: Optional[Mapping[str, Any]] = None,
        bounds: Optional[_Vector] = None,
        up: Optional[_Vector] = None,
        priority: int = 0,
        name: str = "water",
    ) -> None:
        """Adds water below a level [m] with air above it, or changes the region with this `name`.

        Units: `density` [kg/m^3], `viscosity` [Pa s], `current` and `wind` [m/s]. `waves` and `spectrum` are added up.
        `bounds`: six numbers, lowest and highest corner [m]. `up`: direction against gravity. Where regions overlap, the
        one with the highest priority counts, and among equals the one added last. `flow`, of water and air, `flow_above`,
        of the air, and `layers` are those of bullet_ambient.winds.
        """
        single = None if waves is None else [Wave(*wave)._asdict() for wave in waves]
        sea = None if spectrum is None else dict(zip(_SPECTRUM, Spectrum(*spectrum)))
        self._give("water", level=level, density=density, viscosity=viscosity, current=current, waves=single, spectrum=sea,
                   wind=wind, flow=flow, flow_above=flow_above, layers=layers, bounds=_corners(bounds), up=up, priority=int(priority), name=name)

    def air(self, wind: Optional[_Vector] = None, *, bounds: Optional[_Vector] = None, density: Optional[float] = None,
            flow: Optional[_Flows] = None, layers: Optional[Mapping[str, Any]] = None, priority: int = 0,
            name: str = "air") -> None:
        """Adds or changes air with a wind [m/s], everywhere or within bounds. `flow`, `layers`: as in water()."""
        self._give("air", wind=wind, flow=flow, layers=layers, bounds=_corners(bounds), density=density, priority=int(priority), name=name)

    def region(self, name: str = "region", *, density: Optional[float] = None, viscosity: Optional[float] = None,
               velocity: Optional[_Vector] = None, flow: Optional[_Flows] = None,
               layers: Optional[Mapping[str, Any]] = None, bounds: Optional[_Vector] = None, priority: int = 0) -> None:
        """Adds or changes a fluid without a surface, everywhere or within bounds.

        Units: density [kg/m^3], viscosity [Pa s], velocity [m/s]. `flow`, `layers`: as in water().
        """
        self._give("region", name=name, density=density, viscosity=viscosity, velocity=velocity, flow=flow, layers=layers, bounds=_corners(bounds),
                   priority=int(priority))

    def remove(self, name: str = "water") -> None:
        """Removes a region."""
        self._give("remove", name=name)

    def _urdf_frame(self, command: str, body: int, link: int) -> tuple[_Vector, _Vector]:
        """Pose of the frame of a URDF's link in that of its centre of mass. PyBullet crashes if asked for links that are not there."""
        bodies = {self._bullet.getBodyUniqueId(k, physicsClientId=self._client) for k in range(self._bullet.getNumBodies(physicsClientId=self._client))}
        if body not in bodies or not -1 <= link < self._bullet.getNumJoints(body, physicsClientId=self._client):
            raise ValueError(f"{command}: there is no body {body} with link {link}")
        place, turn = self._bullet.invertTransform(*self._bullet.getDynamicsInfo(body, link, physicsClientId=self._client)[3:5])
        return place, turn

    def body(self, body: int, link: int = -1, source: Union[str, Path, FluidBody, Mapping[str, Any], None] = None, *,
             density: Optional[float] = None, drag: Optional[_Vector] = None, medium: Optional[str] = None,
             law: Optional[str] = None, roughness: Optional[float] = None) -> None:
        """Gives a body (link -1: its base) or link a fluid body of your choice; call it anew to change it.

        `source`: an .ambient file, a FluidBody, or a shape as in scenes, {"type": "mesh", "file": "catamaran.stl"}, each in
        the frame of the URDF's link; None: the collision shape. `density`: the body is scaled about its centre of volume
        until it displaces the link's mass over this density [kg/m^3]: for what is mostly air, such as a drone. `drag`:
        measured drag coefficients along x, y, z, on the frontal areas. `medium`, "water" or "air", counts where no region
        is; `law` and `roughness` [m] are those of settings().
        """
        more: dict[str, Any] = {"density": density, "drag": drag, "medium": medium, "law": law, "roughness": roughness}
        if source is None:
            self._give("body", body=body, link=link, **more)
            return
        more["origin"], more["rotation"] = self._urdf_frame("body", body, link)
        if isinstance(source, Mapping):
            source = FluidBody.from_shape(source, origin=(0, 0, 0))
        if isinstance(source, (str, Path)):
            self._give("body", body=body, link=link, file=str(Path(source).resolve()), **more)
            return
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "chosen.ambient"
            source.write(file)
            self._give("body", body=body, link=link, file=str(file), **more)

    def equip(self, body: int, link: int = -1, *, foils: Iterable[Mapping[str, Any]] = (),
              thrusters: Iterable[Mapping[str, Any]] = ()) -> None:
        """Puts foils (rudders, fins, hydrofoils) and thrusters (screws, rotors, jets) on a body or link that is in a fluid.

        Each is a mapping with the keys that `foils` and `thrusters` have in scenes, but for "on"; places and axes are in the
        frame of the URDF's link. Call it after body(), and as often as you like: what came before stays.
        """
        place, turn = self._urdf_frame("equip", body, link)
        on = str(body) if link < 0 else f"{body}/{link}"

        def placed(entry: Mapping[str, Any], axes: Mapping[str, _Vector]) -> dict[str, Any]:
            moved = dict(entry, on=on)
            unturned = (0, 0, 0, 1)
            moved["position"] = self._bullet.multiplyTransforms(place, turn, entry.get("position", (0, 0, 0)), unturned)[0]
            for key, usual in axes.items():
                moved[key] = self._bullet.multiplyTransforms((0, 0, 0), turn, entry.get(key, usual), unturned)[0]
            return moved

        self._give("equip", foils=[placed(foil, {"chord_axis": (1, 0, 0), "span_axis": (0, 1, 0)}) for foil in foils],
                   thrusters=[placed(thruster, {"axis": (1, 0, 0)}) for thruster in thrusters])

    def drive(self, **commands: float) -> None:
        """Sets what foils and thrusters are asked for, by their names, until the next call: `fluid.drive(rudder=0.3)`."""
        self._give("drive", **commands)

    def drives(self) -> dict[str, dict[str, dict[str, float]]]:
        """Returns what foils and thrusters do, as {"foils": {name: ...}, "thrusters": {name: ...}}.

        Of a foil "command" and "angle" [rad]; of a thruster "command", "drive" (thrust [N], or turns [1/s]), and "thrust" [N],
        "torque" [N m] and "power" [W] of the last substep.
        """
        answer: dict[str, dict[str, dict[str, float]]] = json.loads(self._give("drives"))
        return answer

    def read_urdf(self, body: int, file: Union[str, Path]) -> None:
        """Honours the `<ambient>` elements of the URDF file that a body came from; PyBullet itself passes over them.

        Files of fluid bodies are looked for beside the URDF file.
        """
        names = [self._bullet.getBodyInfo(body, physicsClientId=self._client)[0].decode()]
        joints = self._bullet.getNumJoints(body, physicsClientId=self._client)
        names += [self._bullet.getJointInfo(body, i, physicsClientId=self._client)[12].decode() for i in range(joints)]
        for element in ElementTree.parse(file).iter("link"):
            own = element.find("ambient")
            if own is None:
                continue
            name = str(element.get("name"))
            if name not in names:
                raise ValueError(f"{file}: link {name} has an element <ambient>, and body {body} has no such link")
            odd = [f"<{inner.tag}>" for inner in own] + [key for key in own.keys() if key not in _OF_LINKS]
            if odd:
                raise ValueError(f"{file}: link {name}: <ambient> has {odd[0]}; known are: {', '.join(_OF_LINKS)}")
            link = names.index(name) - 1
            if own.get("medium") == "none":
                self.exclude(body, link)
            else:
                source = own.get("fluid_body")
                roughness = own.get("roughness")
                self.body(body, link, Path(file).parent / source if source else None, medium=own.get("medium"),
                          law=own.get("law"), roughness=None if roughness is None else float(roughness))

    def exclude(self, body: int, link: Optional[int] = None) -> None:
        """Removes a body, or one link of it (-1: the base), from the fluid for good; it then moves as in stock PyBullet."""
        self._give("exclude", body=body, link=link)

    def settings(self, *, law: Optional[str] = None, roughness: Optional[float] = None,
                 separation: Optional[float] = None, folder: Optional[str] = None) -> None:
        """Changes settings of all bodies; call before the first step.

        `law`, "form" or "published". `roughness` of all surfaces [m]: at most the root of the area of each body, or this
        and the first region are refused; a smaller body that is loaded later stays out of the fluid, which is said then. `separation`: separation angle of the law
        "published" [rad]. `folder`: all computed shapes are stored there for other runs; default: those that took long, in
        the user's folder.
        """
        self._give("settings", law=law, roughness=roughness, separation=separation, folder=folder)

    def inertia(self, body: int, link: int = -1) -> npt.NDArray[np.float64]:
        """Returns the total inertia (6, 6) of a body or link, rotation first, in its frame at its centre of mass."""
        return np.array(json.loads(self._give("inertia", body=body, link=link)))

    def mass_matrix(self, body: int) -> npt.NDArray[np.float64]:
        """Returns the joint-space inertia with the fluid, 6 + joints rows and columns.

        The first six are the angular velocity and the velocity of the base in world axes. `pybullet.calculateMassMatrix`
        computes it without a fluid.
        """
        return np.array(json.loads(self._give("mass_matrix", body=body)))

    def wrench(self, body: int, link: int = -1) -> dict[str, npt.NDArray[np.float64]]:
        """Returns wrenches on a body or link in the last substep, by part.

        Each: torque about the centre of mass [N m], then force [N], in world axes. The fluid's parts are "pressure",
        "friction", "buoyancy", "waves", "wind" and "added_mass"; "constraints" are those of contacts and joints. The first
        call returns those of the present pose and velocity, without the last two; later ones those of the last substep.
        """
        parts = json.loads(self._give("wrench", body=body, link=link))
        return {name: np.array(part) for name, part in parts.items()}

    def wet(self, body: int, link: int = -1) -> dict[str, Any]:
        """Returns the part of a body or link that is in its fluid, below the surface if one is near.

        "volume" [m^3], "share" of its volume, "draught" of its lowest point [m] (None without a surface), "area" [m^2],
        "centre_of_buoyancy" [m].
        """
        answer: dict[str, Any] = json.loads(self._give("wet", body=body, link=link))
        return answer

    def wet_volume(self, body: int, link: int = -1) -> float:
        """Returns the volume of a body or link that is in its fluid [m^3]."""
        return float(self.wet(body, link)["volume"])

    def save(self) -> int:
        """Saves the state of world and fluid, and returns its number. `pybullet.saveState` does not save the fluid.

        Says once if bodies touch each other and restore() is not bit for bit.
        """
        return int(self._give("save"))

    def restore(self, state: int) -> None:
        """Restores a state of save().

        The motion goes on bit for bit if `pybullet.setPhysicsEngineParameter(deterministicOverlappingPairs=1)` was called
        before, or if no bodies touch each other; not where one touches with several of its collision shapes.
        """
        self._give("restore", state=state)

    def status(self) -> dict[str, Any]:
        """Returns the names of regions, counters of the steps, the first 100 reports of the fluid ("said"), and "bodies".

        "shapes" says how many forms of shapes the process has "made", and "read" from files. Each of "bodies" has the
        numbers of body and link, "mass" [kg], "volume" [m^3], their "density", how its fluid body was "made", and all that
        was "said" of it then; nothing of what was read from files.
        """
        answer: dict[str, Any] = json.loads(self._give("status"))
        return answer

    def off(self) -> None:
        """Removes the fluid; the world then moves as in stock PyBullet.

        Do not call `pybullet.unloadPlugin`: the next `loadPlugin` after it, of any plugin, ends the process.
        """
        self._give("off")

    def _give(self, name: str, /, **values: Any) -> str:
        """Gives the plugin a command with all values that are not None, and returns its answer."""
        given = {key: value for key, value in values.items() if value is not None}
        text = _core._json_text({name: given}, "")
        while len(text) > _PIECE:
            self._send("+" + text[:_PIECE])
            text = text[_PIECE:]
            if text.startswith("+"):  # of a number; as the last text it would be taken for one more piece
                self._send("+" + text[:1])
                text = text[1:]
        return self._send(text)

    def _send(self, text: str) -> str:
        answer = self._bullet.executePluginCommand(self._plugin, text, physicsClientId=self._client)
        if not isinstance(answer, tuple):
            if answer < 0:
                raise ValueError("the command failed, and PyBullet does not say why; is the client connected?")
            return ""
        said = bytes(answer[2]).decode()
        if answer[0] != 0:
            raise ValueError(said)
        return said
