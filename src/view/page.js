// The page of `hemirad view`. What it shows lies in the element #lit-scene; names from a scene are
// only ever set as text. The part after # chooses what is shown first: #camera=NAME&layer=NAME&...
"use strict";

(async () => {
const element = (id) => document.getElementById(id);
const lit = JSON.parse(element("lit-scene").textContent);

function bytesOf(base64) {
    const text = atob(base64);
    const bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
    return bytes;
}

async function inflated(base64) {
    const packed = new Blob([bytesOf(base64)]).stream();
    return new Response(packed.pipeThrough(new DecompressionStream("deflate"))).arrayBuffer();
}

const float32 = (base64) => new Float32Array(bytesOf(base64).buffer);
const uint32 = (base64) => new Uint32Array(bytesOf(base64).buffer);

// --- What is drawn ----------------------------------------------------------------------------

const VERTEX = `
    varying vec2 atlas;
    void main() {
        atlas = uv;
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
    }`;

// Texels share an exponent a colour (Ward 1991), so they are decoded before they are blended.
const FRAGMENT = `
    precision highp float;
    const float PI_ = 3.14159265;
    uniform sampler2D texels;
    uniform vec2 size;
    uniform vec3 reflectance, emission;
    uniform bool isRadiosity, isWhole;
    uniform int show;
    uniform float exposure, largest;
    varying vec2 atlas;

    vec3 texel(vec2 at) {
        vec4 rgbe = texture2D(texels, (clamp(at, vec2(0.0), size - 1.0) + 0.5) / size);
        return rgbe.a == 0.0 ? vec3(0.0) : rgbe.rgb * 255.0 * exp2(floor(rgbe.a * 255.0 + 0.5) - 136.0);
    }
    vec3 blended(vec2 position) {
        vec2 low = floor(position), part = position - low;
        return mix(mix(texel(low), texel(low + vec2(1.0, 0.0)), part.x),
                   mix(texel(low + vec2(0.0, 1.0)), texel(low + 1.0), part.x), part.y);
    }
    vec3 srgb(vec3 linear) {
        return mix(12.92 * linear, 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055,
                   step(0.0031308, linear));
    }
    SCALE
    void main() {
        vec3 value = blended(atlas * size - 0.5);
        if (show == 2) {
            gl_FragColor = vec4(colour((value.r + value.g + value.b) * BANDS / largest), 1.0);
            return;
        }
        vec3 radiance = value / PI_;
        if (show == 0 && !isRadiosity) radiance *= reflectance;
        if (show == 0 && !isRadiosity && isWhole) radiance += emission;
        gl_FragColor = vec4(srgb(1.0 - exp(-exposure * radiance)), 1.0);
    }`;

function scaleShader() {
    const stops = lit.colours.map((c) => `vec3(${c.map((x) => x.toFixed(4)).join(", ")})`);
    let text = "vec3 colour(float t) {\n    t = clamp(t, 0.0, 1.0);\n    vec3 c = " + stops[0] + ";\n";
    for (let i = 1; i < stops.length; ++i)
        text += `    c = mix(c, ${stops[i]}, clamp(t * ${(stops.length - 1).toFixed(1)} - ` +
            `${(i - 1).toFixed(1)}, 0.0, 1.0));\n`;
    return text + "    return c;\n}";
}

const shared = {
    isRadiosity: {value: lit.quantity === "radiosity"}, isWhole: {value: true},
    show: {value: 0}, exposure: {value: 1}, largest: {value: lit.largest},
};

const atlases = lit.atlases.map(({width, height}) => (
    {texels: {value: null}, size: {value: new THREE.Vector2(width, height)}}));

function meshOf(material, positions, uvs) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", positions);
    geometry.setAttribute("uv", uvs);
    geometry.setIndex(new THREE.BufferAttribute(uint32(material.indices), 1));
    const uniforms = Object.assign({
        reflectance: {value: new THREE.Vector3(...material.reflectance)},
        emission: {value: new THREE.Vector3(...material.emission)},
    }, shared, atlases[material.atlas]);
    // Of one band shown as three the sum is that band.
    const fragment = FRAGMENT.replace("SCALE", scaleShader)
        .replace("BANDS", lit.isGrey ? "0.33333333" : "1.0");
    return new THREE.Mesh(geometry, new THREE.ShaderMaterial(
        {vertexShader: VERTEX, fragmentShader: fragment, uniforms}));
}

const scene = new THREE.Scene();
const positions = new THREE.BufferAttribute(float32(lit.positions), 3);
const uvs = new THREE.BufferAttribute(float32(lit.uvs), 2);
for (const material of lit.materials) scene.add(meshOf(material, positions, uvs));

const pictures = new Map();
async function pictureOf(packed, {width, height}) {
    if (pictures.has(packed)) return pictures.get(packed);
    const bytes = new Uint8Array(await inflated(packed));
    const texture = new THREE.DataTexture(bytes, width, height, THREE.RGBAFormat);
    texture.magFilter = texture.minFilter = THREE.NearestFilter;
    texture.needsUpdate = true;
    pictures.set(packed, texture);
    return texture;
}

// --- From where -------------------------------------------------------------------------------

const renderer = new THREE.WebGLRenderer({antialias: true});
renderer.setClearColor(0x222222);
renderer.setPixelRatio(window.devicePixelRatio);
document.body.prepend(renderer.domElement);
const camera = new THREE.PerspectiveCamera(45, 1, lit.radius * 1e-3, lit.radius * 100);
let controls = null;

const overview = {
    name: "overview", eye: [0.9, 0.7, 1.3].map((x) => x * lit.radius * 1.6), target: [0, 0, 0],
    up: [0, 1, 0], yfov: 0.8,
};
const cameras = [...lit.cameras, overview];

function stand(at) {
    camera.position.set(...at.eye);
    camera.up.set(...at.up);
    camera.fov = THREE.Math.radToDeg(at.yfov);
    if (controls) controls.dispose();
    controls = new THREE.OrbitControls(camera, renderer.domElement);  // turns about camera.up
    controls.target.set(...at.target);
    controls.update();
    controls.addEventListener("change", draw);
    resize();
}

function resize() {
    renderer.setSize(window.innerWidth, window.innerHeight);
    camera.aspect = window.innerWidth / window.innerHeight;
    camera.updateProjectionMatrix();
    draw();
}

const draw = () => renderer.render(scene, camera);

// --- The panel --------------------------------------------------------------------------------

function fill(select, names) {
    names.forEach((name, index) => {
        const option = document.createElement("option");
        option.value = index;
        option.textContent = name;
        select.append(option);
    });
}

function drawLegend() {
    const context = element("scale").getContext("2d");
    const gradient = context.createLinearGradient(0, 0, 256, 0);
    lit.colours.forEach((colour, i) => gradient.addColorStop(
        i / (lit.colours.length - 1), `rgb(${colour.map((x) => Math.round(255 * x)).join(",")})`));
    context.fillStyle = gradient;
    context.fillRect(0, 0, 256, 12);
    for (const part of [0, 0.25, 0.5, 0.75, 1]) {
        const number = document.createElement("span");
        number.textContent = (part * shared.largest.value).toPrecision(3) +
            (part === 1 ? " W/m²" : "");
        element("numbers").append(number);
    }
}

const snapshots = lit.snapshots;

// The last of the pictures is the final one, which alone has layers.
async function show() {
    const time = Number(element("time").value);
    const isFinal = time >= snapshots.length;
    const layer = lit.layers[isFinal ? Number(element("layer").value) : 0];
    const texels = isFinal ? layer.texels : snapshots[time].texels;
    const textures = await Promise.all(texels.map((packed, i) => pictureOf(packed, lit.atlases[i])));
    textures.forEach((texture, i) => { atlases[i].texels.value = texture; });
    shared.isWhole.value = !isFinal || layer === lit.layers[0];
    shared.show.value = element("show").selectedIndex;
    shared.exposure.value = lit.exposure * 2 ** Number(element("exposure").value);
    element("stops").textContent = Number(element("exposure").value).toFixed(1);
    element("shots").textContent = isFinal ? "all" : snapshots[time].shots;
    element("legend").hidden = shared.show.value !== 2;
    element("layer").disabled = !isFinal;
    draw();
}

let playing = null;
function play() {
    if (playing !== null) {
        clearInterval(playing);
        playing = null;
        element("play").textContent = "play";
        return;
    }
    const time = element("time");
    if (Number(time.value) >= snapshots.length) time.value = 0;
    element("play").textContent = "stop";
    show();
    playing = setInterval(() => {
        time.value = Number(time.value) + 1;
        show();
        if (Number(time.value) >= snapshots.length) play();
    }, 400);
}

function choose(select, name) {
    const found = [...select.options].find((o) => o.textContent === name || o.value === name);
    if (found) select.value = found.value;
}

function applyHash() {
    const asked = new URLSearchParams(location.hash.slice(1));
    for (const id of ["camera", "layer", "show"])
        if (asked.has(id)) choose(element(id), asked.get(id));
    for (const id of ["exposure", "time"])
        if (asked.has(id)) element(id).value = asked.get(id);
}

document.title = lit.name + " - hemirad";
element("name").textContent = lit.name;
fill(element("camera"), cameras.map((c) => c.name));
fill(element("layer"), lit.layers.map((layer) => layer.name));
element("layer-row").hidden = lit.layers.length < 2;
element("time-row").hidden = snapshots.length === 0;
element("time").max = element("time").value = snapshots.length;
drawLegend();
applyHash();

for (const id of ["layer", "show"]) element(id).addEventListener("change", show);
for (const id of ["exposure", "time"]) element(id).addEventListener("input", show);
element("camera").addEventListener("change", () => stand(cameras[element("camera").value]));
element("play").addEventListener("click", play);
window.addEventListener("resize", resize);

stand(cameras[element("camera").value]);
await show();
document.body.dataset.ready = "yes";
})().catch((fault) => {
    document.getElementById("fault").textContent = "This page needs WebGL and a browser of 2023 or " +
        "later: " + fault;
});
