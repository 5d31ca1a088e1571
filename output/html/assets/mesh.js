'use strict';
// The mesh to turn around, by three.js. What is packed is written by output/html/shown_mesh.cpp.

const TYPES = {u8: [1, Uint8Array], u16: [2, Uint16Array], u32: [4, Uint32Array], f32: [4, Float32Array]};

/** {name: typed array} of what was packed. */
async function unpack(mesh) {
  const raw = Uint8Array.from(atob(mesh.packed), letter => letter.charCodeAt(0));
  const stream = new Blob([raw]).stream().pipeThrough(new DecompressionStream('deflate'));
  const buffer = await new Response(stream).arrayBuffer(), found = {};
  let at = 0;
  for (const {name: key, type, count} of mesh.layout) {
    const [size, Type] = TYPES[type];
    found[key] = new Type(buffer.slice(at, at + size * count));
    at += size * count;
  }
  return found;
}

/** Fans of triangles of all polygons, as three.js takes them; `polygon` of each triangle. Those of the `last` polygons stand behind the others', of which there are `kept`. */
function trianglesOf(mesh, data, back, last) {
  const triangles = data.corners.reduce((sum, count) => sum + count - 2, 0), sides = data.corners.reduce((sum, count) => sum + count, 0);
  const positions = new Float32Array(9 * triangles), polygon = new Uint32Array(triangles), edges = new Float32Array(6 * sides);
  const point = (v, to, at) => {
    for (let c = 0; c < 3; ++c) to[at + c] = mesh.least[c] + data.positions[3 * v + c] / 65535 * mesh.step;
  };
  let t = 0, e = 0, kept = 0, keptEdges = 0;
  for (const late of [false, true]) {
    let first = 0;
    data.corners.forEach((count, k) => {
      if (last[k] === late) {
        for (let c = 2; c < count; ++c, ++t) {
          const fan = back ? [0, c, c - 1] : [0, c - 1, c];
          fan.forEach((corner, place) => point(first + corner, positions, 9 * t + 3 * place));
          polygon[t] = k;
        }
        for (let c = 0; c < count; ++c, e += 6) point(first + c, edges, e), point(first + (c + 1) % count, edges, e + 3);
      }
      first += count;
    });
    if (!late) kept = t, keptEdges = e / 3;
  }
  return {positions, polygon, edges, kept, keptEdges};
}

/** Of each polygon whether a side of it is without light, that comes or leaves: less than a millionth of what is bright. */
function unlit(data, lights, back) {
  const count = data.corners.length, most = lights.map(light => rangeOf(light, count, [false])[1]);
  const dark = Array.from(data.corners, (_, k) => lights.every((light, l) => !(light.of(k, back) > 1e-6 * most[l])));
  return lights.length && dark.includes(false) ? dark : dark.fill(false);
}

const srgb = value => value <= 0.0031308 ? 12.92 * value : 1.055 * value ** (1 / 2.4) - 0.055;

/** What can be coloured: [{key, label, unit, of: k => value or null}] and, of the light, {rgb}. */
function quantities(page, mesh, data) {
  const units = page.units, side = (key, back) => data[key + (back ? '_back' : '')];
  const found = [];
  const weighed = key => (k, back) => {
    const values = side(key, back);
    return values ? luminance([values[3 * k], values[3 * k + 1], values[3 * k + 2]]) : null;
  };
  if (data.radiosity) found.push({label: 'as shown', shown: true, of: weighed('radiosity')},
    {isLight: true, label: 'radiosity B', unit: units.exitance, of: weighed('radiosity')});
  if (data.irradiance) found.push({isLight: true, label: 'irradiance E', unit: units.irradiance, of: weighed('irradiance')});
  if (data.material) found.push({label: 'reflectance ρ', unit: '', from: 0, to: 1, of: k => luminance(mesh.reflectance[data.material[k]])});
  if (data.temperature) found.push({label: 'temperature T', unit: units.temperature, fromLeast: true, of: (k, back) => side('temperature', back)[k]});
  if (data.error) found.push({label: mesh.error_is, unit: mesh.error_unit, diverging: mesh.diverging, of: (k, back) => (side('error', back) || data.error)[k]});
  if (data.group && mesh.groups.length > 1) found.push({label: 'group', hues: true, of: k => data.group[k]});
  return found;
}

function rangeOf(quantity, count, backs) {
  if (quantity.to !== undefined) return [quantity.from, quantity.to];
  const values = [];
  for (const back of backs)
    for (let k = 0; k < count; ++k) {
      const value = quantity.of(k, back);
      if (Number.isFinite(value)) values.push(value);
    }
  values.sort((a, b) => a - b);
  // A lamp must not make all else dark: of a hundred values one may be beyond the scale.
  const at = share => values[Math.round(share * (values.length - 1))] || 0;
  if (quantity.diverging) {
    const most = Math.max(Math.abs(at(0.01)), Math.abs(at(0.99)), 1e-30);
    return [-most, most];
  }
  const from = quantity.fromLeast ? at(0) : 0;
  const to = quantity.fromLeast ? at(1) : at(0.99);
  return [from, to > from ? to : from + 1];
}

function colourOf(page, quantity, [from, to], data, k, back) {
  if (quantity.shown) {
    const values = data['radiosity' + (back ? '_back' : '')], Y = quantity.of(k, back) / to;
    const compressed = Y > 0 ? (Y * (1 + Y / 4)) / (1 + Y) / Y : 1;
    return [0, 1, 2].map(c => Math.min(1, values[3 * k + c] / to * compressed * 1.2));
  }
  const value = quantity.of(k, back);
  if (!Number.isFinite(value)) return [0.5, 0.5, 0.5];
  if (quantity.hues) {
    const hue = new THREE.Color().setHSL((value * 0.618034) % 1, 0.55, 0.6);
    return [hue.r, hue.g, hue.b];
  }
  const colours = quantity.diverging ? page.diverging : page.palette;
  return paletteColour(colours, (value - from) / (to - from)).map(c => c / 255);
}

function said(page, mesh, data, all, k, back) {
  const rows = all.filter(quantity => !quantity.shown && !quantity.hues).map(quantity => {
    const value = quantity.of(k, back);
    return `${quantity.label}: ${number(value, 4)} ${quantity.unit || ''}`;
  });
  const group = data.group ? mesh.groups[data.group[k]] : null, material = data.material ? mesh.materials[data.material[k]] : null;
  const what = mesh.decimated ? 'cell' : `element ${k}`;
  return make('span', {}, `${what}${data.radiosity_back ? back ? ', back' : ', front' : ''}`,
    group !== null && group !== undefined ? [', group ', name(group)] : [], material ? [', material ', name(material)] : [], '\n' + rows.join('\n'));
}

/** The view with its controls; throws where there is no WebGL. */
async function meshView(page) {
  const mesh = page.mesh, data = await unpack(mesh), all = quantities(page, mesh, data);
  const backs = data.radiosity_back || data.temperature_back ? [false, true] : [false];
  const text = make('p', {class: 'said'}, 'Drag to turn, scroll to come nearer, click an element for its values.');
  const box = make('div', {class: 'mesh', id: 'mesh'}, text), select = make('select', {id: 'quantity', 'aria-label': 'what is coloured'}), scale = make('span');
  all.forEach((quantity, k) => select.append(make('option', {value: k}, quantity.label)));
  // Heat is not seen.
  select.value = Math.max(0, all.findIndex(quantity => quantity.fromLeast));
  const wires = make('input', {type: 'checkbox', id: 'wires'}), through = make('input', {type: 'checkbox', id: 'through'}), lit = make('input', {type: 'checkbox', id: 'lit'});
  through.checked = lit.checked = true;
  // Without light are the outsides of a room, say.
  const lights = all.filter(quantity => quantity.isLight), dark = backs.map(back => unlit(data, lights, back)), someDark = dark.some(of => of.includes(true));
  const whole = make('div', {}, make('div', {class: 'controls'}, make('label', {}, 'colours: ', select),
    make('label', {}, wires, ' wireframe'), make('label', {}, through, ' leave out backs'), someDark ? make('label', {}, lit, ' leave out what is unlit') : null, scale), box);

  const renderer = new THREE.WebGLRenderer({antialias: true, preserveDrawingBuffer: true});
  box.prepend(renderer.domElement);
  const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera(45, 1, mesh.step / 1000, 20 * mesh.step);
  scene.background = new THREE.Color(0x20242a);
  const solids = backs.map(back => {
    const {positions, polygon, edges, kept, keptEdges} = trianglesOf(mesh, data, back, dark[Number(back)]), geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
    geometry.setAttribute('color', new THREE.BufferAttribute(new Float32Array(positions.length), 3));
    const solid = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({vertexColors: THREE.VertexColors, side: backs.length > 1 ? THREE.FrontSide : THREE.DoubleSide,
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1}));
    solid.userData = {polygon, back, kept, keptEdges};
    scene.add(solid);
    if (!back) {
      const lattice = new THREE.BufferGeometry();
      lattice.setAttribute('position', new THREE.BufferAttribute(edges, 3));
      solid.userData.wires = new THREE.LineSegments(lattice, new THREE.LineBasicMaterial({color: 0x000000, transparent: true, opacity: 0.35}));
      solid.userData.wires.visible = false;
      scene.add(solid.userData.wires);
    }
    return solid;
  });
  const middle = new THREE.Vector3(...mesh.least.map((least, c) => least + mesh.size[c] / 2)), radius = Math.hypot(...mesh.size) / 2;
  camera.up.set(...mesh.up);
  const across = Math.abs(mesh.up[1]) > 0.9 ? new THREE.Vector3(0.7, 0.5, 1) : new THREE.Vector3(0.7, -1, 0.5);
  camera.position.copy(middle).addScaledVector(across.normalize(), 2.15 * radius);
  const controls = new THREE.OrbitControls(camera, renderer.domElement);
  controls.target.copy(middle);
  controls.update();

  const draw = () => renderer.render(scene, camera);
  const paint = () => {
    const quantity = all[Number(select.value)], range = rangeOf(quantity, data.corners.length, backs);
    for (const solid of solids) {
      const colours = solid.geometry.attributes.color, {polygon, back} = solid.userData;
      let last = -1, colour = null;
      polygon.forEach((k, t) => {
        if (k !== last) {
          colour = colourOf(page, quantity, range, data, k, back);
          if (quantity.shown) colour = colour.map(srgb);
          last = k;
        }
        for (let c = 0; c < 9; ++c) colours.array[9 * t + c] = colour[c % 3];
      });
      colours.needsUpdate = true;
    }
    scale.replaceChildren(...(quantity.shown || quantity.hues ? [] : [scaleBar(quantity.diverging ? page.diverging : page.palette, ...range, quantity.unit || '')]));
    draw();
  };
  const fit = () => {
    const {clientWidth: width, clientHeight: height} = box;
    if (!width || !height) return;
    renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    renderer.setSize(width, height, false);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    draw();
  };
  const pick = event => {
    const frame = renderer.domElement.getBoundingClientRect(), ray = new THREE.Raycaster();
    ray.setFromCamera({x: 2 * (event.clientX - frame.left) / frame.width - 1, y: 1 - 2 * (event.clientY - frame.top) / frame.height}, camera);
    const hit = ray.intersectObjects(solids.filter(solid => solid.visible))[0];
    text.replaceChildren(hit ? said(page, mesh, data, all, hit.object.userData.polygon[hit.faceIndex], hit.object.userData.back) : 'Nothing is here.');
  };
  let pressed = null;
  renderer.domElement.addEventListener('pointerdown', event => { pressed = [event.clientX, event.clientY]; });
  renderer.domElement.addEventListener('click', event => {
    // A drag that turns the view ends with a click too.
    if (!pressed || Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) < 5) pick(event);
  });
  controls.addEventListener('change', draw);
  select.addEventListener('change', paint);
  wires.addEventListener('change', () => { solids[0].userData.wires.visible = wires.checked; draw(); });
  // From outside one looks into a room through the walls that face away.
  const cull = () => {
    for (const solid of solids) solid.material.side = through.checked || backs.length > 1 ? THREE.FrontSide : THREE.DoubleSide;
    if (backs.length > 1) solids[1].visible = !through.checked;
    for (const {geometry, userData} of solids) {
      geometry.setDrawRange(0, lit.checked ? 3 * userData.kept : Infinity);
      if (userData.wires) userData.wires.geometry.setDrawRange(0, lit.checked ? userData.keptEdges : Infinity);
    }
    solids.forEach(solid => { solid.material.needsUpdate = true; });
    draw();
  };
  through.addEventListener('change', cull);
  lit.addEventListener('change', cull);
  new ResizeObserver(fit).observe(box);
  cull();
  paint();
  return whole;
}

function hasWebGL() {
  try {
    return Boolean(make('canvas').getContext('webgl'));
  } catch (error) {
    return false;
  }
}
