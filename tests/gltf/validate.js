// node validate.js FILE...: Khronos's glTF validator on each; prints its issues of a severity below
// information as JSON, {file: [messages]}. The folder of gltf-validator is in NODE_PATH.
const fs = require("fs");
const path = require("path");
const validator = require("gltf-validator");

const INFORMATION = 2;

async function faults(file) {
    const folder = path.dirname(file);
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {
        uri: path.basename(file),
        externalResourceFunction: async (uri) =>
            new Uint8Array(fs.readFileSync(path.join(folder, decodeURIComponent(uri)))),
    });
    return report.issues.messages.filter((message) => message.severity < INFORMATION);
}

(async () => {
    const found = {};
    for (const file of process.argv.slice(2)) found[file] = await faults(file);
    console.log(JSON.stringify(found));
})();
