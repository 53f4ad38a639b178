// Prints what Khronos' validator says of glTF files: node validate.js FOLDER_OF_NODE_MODULES FILE ...
const { readFileSync } = require('fs');
const { createRequire } = require('module');

const [folder, ...files] = process.argv.slice(2);
const validator = createRequire(`${folder}/`)('gltf-validator');

Promise.all(files.map((file) => validator.validateBytes(new Uint8Array(readFileSync(file)))))
  .then((reports) => console.log(JSON.stringify(reports.map((report) => report.issues))));
