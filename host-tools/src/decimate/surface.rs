//! The surface that is decimated: a half-edge mesh, and what each corner of its triangles carries.
//!
//! A *wedge* is a run of neighbouring corners at one vertex that share a normal and a material. A vertex has several where
//! materials meet, or normals that differ. A collapse takes each wedge of the vertex that goes to the wedge that
//! the edge's own triangles have at the other end; where they do not say, or disagree, it is refused. So a vertex inside
//! one material can go anywhere, one on an outline only along it, and one where outlines meet stays (Hoppe, "New Quadric
//! Metric for Simplifying Meshes with Appearance Attributes", 1999, has wedges).

use std::collections::HashMap;

use alum::{EditableTopology, HH, Handle, HasIterators, HasTopology, PolyMeshF64, VH};
use glam::DVec3;

use super::quadric::Quadric;
use crate::model::Model;

/// How much the planes that stand upright on outlines weigh, against the surface's own.
const OUTLINE: f64 = 1.0;
/// How much the points weigh; it keeps vertices from wandering in planes, where they are free.
const PULL: f64 = 1e-6;
/// The least cosine of the angle by which a collapse may turn a triangle.
const TURN: f64 = 0.2;

/// A model's surface.
pub(super) struct Surface {
    /// Who is next to whom; its points are not used.
    pub(super) mesh: PolyMeshF64,
    /// By vertex of the mesh, scene units.
    pub(super) positions: Vec<DVec3>,
    /// By face of the mesh.
    pub(super) faces: Vec<Face>,
    /// How many of the faces are left.
    pub(super) triangles: usize,
    /// The sum of each wedge's normals, by area.
    normals: Vec<DVec3>,
    /// By vertex, about `centre`.
    quadrics: Vec<Quadric>,
    /// Far from zero, squares of coordinates would leave no digits for differences.
    centre: DVec3,
    /// Vertices that neither move nor go.
    is_fixed: Vec<bool>,
    edges: Vec<HH>,
}

/// A triangle of the surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    /// Its index in the model.
    pub(super) id: usize,
    pub(super) corners: [Corner; 3],
    pub(super) is_left: bool,
}

/// A corner of a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) vertex: usize,
    pub(super) wedge: usize,
}

/// A collapse that is possible.
pub(super) struct Collapse {
    /// From the vertex that goes to the one that stays.
    edge: HH,
    /// Where the one that stays goes.
    place: DVec3,
    /// What it costs: squared distance times area, summed.
    pub(super) error: f64,
}

/// Where the wedges of the vertex that goes go: (its own, the other vertex's) for each triangle at the edge.
type Pairs = [Option<(usize, usize)>; 2];

impl Face {
    fn wedge(&self, vertex: VH) -> Option<usize> {
        self.corners.iter().find(|corner| corner.vertex == index(vertex)).map(|corner| corner.wedge)
    }
}

impl Surface {
    /// The surface of a model.
    ///
    /// # Errors
    /// None that a model can cause.
    pub(super) fn new(model: &Model) -> Result<Self, alum::Error> {
        let centre = model.positions.iter().fold(DVec3::ZERO, |sum, &p| sum + p / model.positions.len() as f64);
        let mut surface = Self {
            mesh: PolyMeshF64::new(),
            positions: Vec::new(),
            faces: Vec::new(),
            triangles: 0,
            normals: Vec::new(),
            quadrics: Vec::new(),
            centre,
            is_fixed: Vec::new(),
            edges: Vec::new(),
        };
        let mut vertices = HashMap::new();
        for (id, triangle) in model.triangles.iter().enumerate() {
            let points = triangle.vertices.map(|v| model.positions[v as usize]);
            let mut corners = [VH::from(0); 3];
            for (corner, point) in corners.iter_mut().zip(points) {
                *corner = match vertices.get(&bits(point)) {
                    Some(&vertex) => vertex,
                    None => *vertices.entry(bits(point)).or_insert(surface.add_vertex(point)?),
                };
            }
            let [a, b, c] = corners;
            if a == b || b == c || c == a {
                continue;
            }
            if surface.mesh.add_tri_face(a, b, c).is_err() {
                // More than two triangles at an edge: this one gets vertices of its own, and all stay in place.
                for (corner, point) in corners.iter_mut().zip(points) {
                    surface.is_fixed[index(*corner)] = true;
                    *corner = surface.add_vertex(point)?;
                    surface.is_fixed[index(*corner)] = true;
                }
                surface.mesh.add_tri_face(corners[0], corners[1], corners[2])?;
            }
            let vertices = corners.map(index);
            surface.faces.push(Face { id, corners: vertices.map(|vertex| Corner { vertex, wedge: 0 }), is_left: true });
        }
        surface.triangles = surface.faces.len();
        surface.number_wedges(model);
        surface.measure();
        Ok(surface)
    }

    fn add_vertex(&mut self, point: DVec3) -> Result<VH, alum::Error> {
        self.positions.push(point);
        self.is_fixed.push(false);
        self.mesh.add_vertex(alum::DVec3(point.x, point.y, point.z))
    }

    /// Gives each run of corners its wedge.
    fn number_wedges(&mut self, model: &Model) {
        for vertex in self.mesh.vertices() {
            // Around the vertex; none where the surface is open.
            let ring: Vec<_> = self.mesh.voh_ccw_iter(vertex).map(|half| half.face(&self.mesh).map(index)).collect();
            let traits = |face: usize| {
                let Face { id, corners, .. } = self.faces[face];
                let corner = corners.iter().position(|corner| corner.vertex == index(vertex))?;
                Some((corner, smooth_normals(model, id).map(|normals| normals[corner]), model.triangles[id].material))
            };
            let traits: Vec<_> = ring.iter().map(|face| traits((*face)?)).collect();
            let key = |k: usize| traits[k % traits.len()].map(|(_, normal, material)| (normal, material));
            // From where one begins, so that none is cut in two.
            let start = (1..=ring.len()).find(|&k| key(k) != key(k - 1)).unwrap_or(0);
            for k in start..start + ring.len() {
                if k == start || key(k) != key(k - 1) {
                    self.normals.push(DVec3::ZERO);
                }
                let k = k % ring.len();
                if let (Some(face), Some((corner, normal, _))) = (ring[k], traits[k]) {
                    let wedge = self.normals.len() - 1;
                    let face = &mut self.faces[face];
                    face.corners[corner].wedge = wedge;
                    let weight = area(face.corners.map(|corner| self.positions[corner.vertex])).length();
                    self.normals[wedge] += normal.unwrap_or_default() * weight;
                }
            }
        }
    }

    /// Makes the quadrics.
    fn measure(&mut self) {
        let mut quadrics = vec![Quadric::default(); self.positions.len()];
        for face in &self.faces {
            let points = face.corners.map(|corner| self.positions[corner.vertex] - self.centre);
            let area = area(points);
            let plane = Quadric::plane(area.normalize_or_zero(), points[0], area.length());
            for (corner, point) in face.corners.iter().zip(points) {
                quadrics[corner.vertex] += plane + Quadric::point(point, PULL * area.length());
            }
        }
        for edge in self.mesh.edges() {
            let (half, other) = edge.halfedges();
            let [left, right] = self.pairs(half);
            if left == right {
                continue;
            }
            let ends = [half.tail(&self.mesh), half.head(&self.mesh)].map(|v| self.positions[index(v)] - self.centre);
            let along = ends[1] - ends[0];
            for face in [half, other].into_iter().filter_map(|h| h.face(&self.mesh)) {
                let normal = area(self.faces[index(face)].corners.map(|c| self.positions[c.vertex]));
                let upright = along.cross(normal).normalize_or_zero();
                let plane = Quadric::plane(upright, ends[0], OUTLINE * along.length_squared());
                quadrics[index(half.tail(&self.mesh))] += plane;
                quadrics[index(half.head(&self.mesh))] += plane;
            }
        }
        self.quadrics = quadrics;
    }

    /// A wedge's normal, unless it is a flat one's, or its normals cancel.
    pub(super) fn normal(&self, wedge: usize) -> Option<DVec3> {
        self.normals[wedge].try_normalize()
    }

    /// The collapse of a vertex that changes the surface least.
    pub(super) fn cheapest(&self, vertex: VH) -> Option<Collapse> {
        if self.is_fixed[index(vertex)] {
            return None;
        }
        let collapses = self.mesh.voh_ccw_iter(vertex).filter_map(|edge| self.examine(edge));
        collapses.min_by(|a, b| a.error.total_cmp(&b.error))
    }

    /// What a collapse costs, if it is possible.
    fn examine(&self, edge: HH) -> Option<Collapse> {
        let (tail, head) = (edge.tail(&self.mesh), edge.head(&self.mesh));
        let pairs = self.pairs(edge);
        if !self.takes_along(tail, &pairs) || !self.mesh.try_check_edge_collapse(edge).is_ok_and(|legal| legal) {
            return None;
        }
        // A tetrahedron would become two triangles, back to back.
        let is_closed = !tail.is_boundary(&self.mesh) && !head.is_boundary(&self.mesh);
        if is_closed && tail.valence(&self.mesh) == 3 && head.valence(&self.mesh) == 3 {
            return None;
        }
        let quadric = self.quadrics[index(tail)] + self.quadrics[index(head)];
        let is_free = !self.is_fixed[index(head)]
            && tail.is_boundary(&self.mesh) == head.is_boundary(&self.mesh)
            && self.takes_along(head, &pairs.map(|pair| pair.map(|(tail, head)| (head, tail))));
        let least = is_free.then(|| quadric.minimum() + self.centre).filter(|place| place.is_finite());
        [least, Some(self.positions[index(head)])]
            .into_iter()
            .flatten()
            .find(|&place| !self.turns_over(tail, head, place))
            .map(|place| Collapse { edge, place, error: quadric.error(place - self.centre) })
    }

    /// The wedges that correspond at both ends of an edge, to its left and to its right.
    fn pairs(&self, edge: HH) -> Pairs {
        let (tail, head) = (edge.tail(&self.mesh), edge.head(&self.mesh));
        [edge, edge.opposite()].map(|half| {
            let face = &self.faces[index(half.face(&self.mesh)?)];
            Some((face.wedge(tail)?, face.wedge(head)?))
        })
    }

    /// Whether each wedge of a vertex has one counterpart.
    fn takes_along(&self, vertex: VH, pairs: &Pairs) -> bool {
        let agree = match pairs {
            [Some(left), Some(right)] => left.0 != right.0 || left.1 == right.1,
            _ => true,
        };
        let mut wedges = self.mesh.vf_ccw_iter(vertex).map(|face| self.faces[index(face)].wedge(vertex));
        agree && wedges.all(|wedge| pairs.iter().flatten().any(|pair| Some(pair.0) == wedge))
    }

    /// Whether a triangle that stays would turn too far.
    fn turns_over(&self, tail: VH, head: VH, place: DVec3) -> bool {
        let turns = |moved: VH, other: VH| {
            self.mesh.vf_ccw_iter(moved).map(|face| &self.faces[index(face)]).any(|face| {
                if face.wedge(other).is_some() {
                    return false;
                }
                let before = face.corners.map(|corner| self.positions[corner.vertex]);
                let after = face.corners.map(|corner| match corner.vertex == index(moved) {
                    true => place,
                    false => self.positions[corner.vertex],
                });
                let (before, after) = (area(before), area(after));
                before.dot(after) < TURN * before.length() * after.length()
                    || (after == DVec3::ZERO && before != DVec3::ZERO)
            })
        };
        turns(tail, head) || (place != self.positions[index(head)] && turns(head, tail))
    }

    /// Collapses; returns the vertices whose surroundings have changed, the one that stays first.
    ///
    /// # Errors
    /// None after [`Surface::cheapest`].
    pub(super) fn collapse(&mut self, collapse: &Collapse) -> Result<Vec<VH>, alum::Error> {
        let edge = collapse.edge;
        let (tail, head) = (edge.tail(&self.mesh), edge.head(&self.mesh));
        let pairs = self.pairs(edge);
        for face in self.mesh.vf_ccw_iter(tail).map(index) {
            let face = &mut self.faces[face];
            if face.wedge(head).is_some() {
                face.is_left = false;
                self.triangles -= 1;
            }
            for corner in face.corners.iter_mut().filter(|corner| corner.vertex == index(tail)) {
                corner.vertex = index(head);
                if let Some(pair) = pairs.iter().flatten().find(|pair| pair.0 == corner.wedge) {
                    corner.wedge = pair.1;
                }
            }
        }
        let [left, right] = pairs;
        for (gone, stays) in [left, right.filter(|_| right != left)].into_iter().flatten() {
            let normal = self.normals[gone];
            self.normals[stays] += normal;
        }
        let quadric = self.quadrics[index(tail)];
        self.quadrics[index(head)] += quadric;
        self.positions[index(head)] = collapse.place;
        self.mesh.try_collapse_edge(edge, &mut self.edges)?;
        Ok([head].into_iter().chain(self.mesh.vv_ccw_iter(head)).collect())
    }
}

/// The normals of a triangle's corners, unless it is flat: with none, or with one for all.
fn smooth_normals(model: &Model, id: usize) -> Option<[DVec3; 3]> {
    let normals = model.triangles[id].normals?.map(|n| model.normals[n as usize]);
    (normals != [normals[0]; 3]).then_some(normals)
}

/// Twice the area, as a vector square to the triangle.
fn area([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

/// What tells two vectors apart; zero has one sign.
fn bits(v: DVec3) -> [u64; 3] {
    v.to_array().map(|c| (c + 0.0).to_bits())
}

fn index(handle: impl Handle) -> usize {
    handle.index() as usize
}
