'use strict';

const KINDS = {solve: 'Solution', view: 'View of a solution', reference: 'Reference by paths of light', photons: 'Photons', compare: 'Comparison', viewfactors: 'View factors'};

async function meshSection(page) {
  if (page.mesh_left_out) return section('Mesh', make('p', {}, 'This program was built without three.js, which shows the mesh. The other files of the run have it, for programs of their own.'));
  if (!page.mesh) return null;
  const about = page.mesh.decimated ? `${page.mesh.elements.toLocaleString('en').replace(/,/g, ' ')} elements are too many for this page: shown are cells that have the mean of those in them${page.mesh.left_out ? `, but for the ${page.mesh.left_out} smallest, which are left out` : ''}.` : null;
  let view;
  try {
    if (!hasWebGL()) throw new Error('this browser shows no WebGL');
    view = await meshView(page);
  } catch (error) {
    view = make('p', {id: 'no-mesh'}, `The mesh cannot be shown here: ${error.message}. The other files of the run have it, for programs of their own.`);
  }
  return section('Mesh', about ? make('p', {class: 'faint'}, about) : null, view);
}

async function show() {
  const page = JSON.parse(document.getElementById('data').textContent);
  const place = document.getElementById('page'), mesh = make('div');
  place.append(...[make('h1', {}, name(page.name)), make('p', {class: 'faint'}, page.live ? 'Under way; this page is read again every few seconds.' : page.dry ? 'Forecast (dry run)' : KINDS[page.kind]),
    warnings(page), howGood(page), progress(page), pictures(page), receivers(page), tasks(page), heat(page), comparison(page), factorMatrix(page), mesh,
    energy(page), time(page), sizes(page), repeat(page)].filter(part => part));
  const found = await meshSection(page);
  if (found) mesh.replaceWith(found);
  else mesh.remove();
  document.body.dataset.ready = 'yes';
}

show().catch(error => {
  document.getElementById('page').append(make('p', {class: 'verdict bad'}, `This page cannot be shown: ${error.message}`));
  throw error;
});
