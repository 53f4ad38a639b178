// Prints what MuJoCo makes of MJCF files: node mujoco_forces.mjs FOLDER_OF_NODE_MODULES FILE ...
// For each: mass, virtual mass and inertia of its geom, forces of the fluid at velocity 1 along and about each axis, the
// moment about z of a velocity 1 along x and y, and accelerations, at rest, by its weight and by a push of 1 N along x.
import { readFileSync } from "fs";
import { createRequire } from "module";
import { pathToFileURL } from "url";

const [folder, ...files] = process.argv.slice(2);
const { default: load } = await import(pathToFileURL(createRequire(`${folder}/`).resolve("@mujoco/mujoco")));
const mujoco = await load();

function look(file) {
  mujoco.FS.writeFile("/body.xml", readFileSync(file));
  const model = mujoco.MjModel.from_xml_path("/body.xml");
  const data = new mujoco.MjData(model);
  const drag = [];
  for (let k = 0; k < 6; ++k) {
    data.qvel.fill(0);
    data.qvel[k] = 1;
    mujoco.mj_forward(model, data);
    drag.push(-data.qfrc_fluid[k]);
  }
  data.qvel.fill(0);
  data.qvel[0] = data.qvel[1] = 1;
  mujoco.mj_forward(model, data);
  const munk = data.qfrc_fluid[5];
  data.qvel.fill(0);
  mujoco.mj_forward(model, data);
  const fall = Array.from(data.qacc);
  data.qfrc_applied[0] = 1;
  mujoco.mj_forward(model, data);
  const added = Array.from(model.geom_fluid).slice(6, 12);
  return { mass: model.body_mass[1], added, drag, munk, fall, pushed: Array.from(data.qacc) };
}

console.log(JSON.stringify(files.map(look)));
