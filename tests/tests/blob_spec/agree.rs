//! Whether a blob says what the model says that it was made from, and keeps to the document's rules.

use std::collections::HashSet;

use glam::DVec3;
use host_tools::model::{self, Background, Format, LightKind, Material, Model, Projection, Transfer};

use crate::looks;
use crate::reader::{Blob, Bounds, Header, Radiance};

pub(crate) type Checked = Result<(), String>;

pub(crate) fn rule(holds: bool, what: &str) -> Checked {
    if holds { Ok(()) } else { Err(what.into()) }
}

fn within(values: &[i64], (least, most): (i64, i64)) -> bool {
    values.iter().all(|value| (least..=most).contains(value))
}

fn cross(a: [i64; 3], b: [i64; 3]) -> [i64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn minus(a: [i64; 3], b: [i64; 3]) -> [i64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Checks everything.
///
/// # Errors
/// What does not agree.
pub(crate) fn agree(blob: &Blob, model: &Model) -> Checked {
    header(blob, model)?;
    camera(blob, model)?;
    tree(blob)?;
    origins(blob)?;
    triangles(blob, model)?;
    spheres(blob, model)?;
    normals(blob, model)?;
    shading(blob, model)
}

fn place(blob: &Blob, point: DVec3) -> [i64; 3] {
    let grid = (point - DVec3::from_array(blob.header.origin)) * blob.header.scale;
    grid.to_array().map(|c| (c + 0.5).floor() as i64)
}

/// Light within what 16 bits of the strongest channel leave open.
fn is_light(radiance: &Radiance, light: DVec3) -> bool {
    let step = 2_f64.powi(radiance.exponent as i32 - 16);
    let strongest = radiance.mantissa.into_iter().max().unwrap_or(0);
    let close =
        radiance.mantissa.iter().zip(light.to_array()).all(|(&m, c)| (f64::from(m) * step - c).abs() <= step / 2.0);
    let least = strongest >= 1 << 15 || radiance.exponent == -15 || (strongest == 0 && radiance.exponent == 0);
    close && least && (-15..=15).contains(&radiance.exponent)
}

fn header(blob: &Blob, model: &Model) -> Checked {
    let header = &blob.header;
    let any_kind = |point: bool| model.lights.iter().any(|l| matches!(l.kind, LightKind::Point(_)) == point);
    let smooth = model.triangles.iter().any(|t| t.normals.is_some());
    let linear = model.render.transfer == Transfer::Linear;
    let used = model.triangles.iter().map(|t| t.material).chain(model.spheres.iter().map(|s| s.material));
    let needs = [
        any_kind(true),
        any_kind(false),
        !model.lights.is_empty() && model.render.shadows,
        smooth,
        used.clone().any(|m| model.materials[m as usize].emission != DVec3::ZERO),
        model.render.ambient != DVec3::ZERO && !model.render.paths,
        !linear,
        linear,
        header.needs >> 33 & 1 == 1 && model.triangles.len() + model.spheres.len() > 65_536,
        blob.normals.len() >= 65_536,
        false,
        false,
        false,
        false,
        !blob.spheres.is_empty(),
    ];
    let needs = needs.iter().rev().fold(0u64, |bits, &need| bits << 1 | u64::from(need))
        | looks::needs(blob, model)
        | crate::painted::needs(blob, model);
    let format = match model.render.format {
        Format::Rgb888 => 0,
        Format::Rgb565 => 1,
        Format::Gray8 => 2,
    };
    let parallel = matches!(model.camera.projection, Projection::Orthographic { .. });
    let pixels = u64::from(parallel) << 19
        | u64::from(model.render.samples > 1 && !model.render.paths) << 20
        | 1 << (25 + format);
    let (has, shared) = (!blob.triangles.is_empty(), header.needs >> 31 & 1 == 1);
    let bits = |count: usize| count.next_power_of_two().ilog2();
    // The largest material has all its bits set.
    let room = blob.kernel.material_most.count_ones();
    let beside = !shared && blob.spheres.is_empty() && bits(model.triangles.len()) + bits(blob.materials.len()) <= room;
    let layout = u64::from(has && !shared) << 29
        | u64::from(has && shared) << 31
        | u64::from(!beside) << 33
        | u64::from(beside) << 34;
    rule(!beside || header.material_bits == bits(blob.materials.len()), "bits of materials")?;
    rule(header.needs == needs | pixels | layout, "needs")?;
    rule(header.format == format, "format")?;
    rule(header.samples == u64::from(model.render.samples), "samples")?;
    rule(header.size == model.render.size.map(u64::from), "size")?;
    rule(header.transfer == u64::from(linear), "transfer")?;
    rule(header.file_triangles == model.triangles.len() as u64, "triangles in the file")?;
    rule(header.file_spheres == model.spheres.len() as u64, "spheres in the file")?;
    rule(header.arithmetic == [0; 4], "arithmetic")?;
    rule(blob.corners.len() == if smooth { blob.triangles.len() } else { 0 }, "smooth")?;
    let [bottom, top] = match model.background {
        Background::Colour(colour) => [colour; 2],
        Background::Sky { bottom, top } => [bottom, top],
    };
    let [down, up] = &header.background;
    rule(is_light(down, bottom) && is_light(up, top), "background")?;
    let ambient = if model.render.paths { DVec3::ZERO } else { model.render.ambient };
    rule(is_light(&header.ambient, ambient), "ambient")
}

/// The camera's frame: forward, right, up.
fn frame(model: &Model) -> [DVec3; 3] {
    let camera = &model.camera;
    let forward = (camera.look_at - camera.position).normalize();
    let right = forward.cross(camera.up).normalize();
    [forward, right, right.cross(forward)]
}

fn camera(blob: &Blob, model: &Model) -> Checked {
    let (header, kernel) = (&blob.header, &blob.kernel);
    let [forward, right, up] = frame(model);
    let [width, height] = header.size.map(|side| side as f64);
    let half = (1_i64 << header.fraction_bits) >> 1;
    let (bits, bits_most) = match model.camera.projection {
        Projection::Perspective { .. } => (kernel.direction_bits, kernel.fraction_bits_most),
        Projection::Orthographic { .. } => (kernel.offset_bits, kernel.fraction_bits_parallel),
    };
    rule(header.fraction_bits <= bits_most, "fraction bits")?;
    let bound = 1_i64 << (bits + u32::from(header.fraction_bits));
    let is_perspective = matches!(model.camera.projection, Projection::Perspective { .. });
    rule(!is_perspective || header.eye == place(blob, model.camera.position), "eye")?;
    // Twice the place, so that the corners of the picture are whole: they count where there are several samples.
    let (out, left) = if is_sampled(header) { (1, 2) } else { (0, 0) };
    let last = header.size.map(|side| 2 * (side as i64 - 1) + out);
    let mut starts = Vec::new();
    for (x, y) in [(-out, -out), (last[0], -out), (-out, last[1]), (last[0], last[1])] {
        let mut step = [0.0; 3];
        for (axis, component) in step.iter_mut().enumerate() {
            let sum = 2 * header.first[axis] + x * header.right[axis] + y * header.down[axis];
            rule(sum.abs() + 2 * (half + left) < 2 * bound, "range of directions")?;
            *component = if out == 0 {
                ((sum / 2 + half) >> header.fraction_bits) as f64
            } else {
                sum as f64 / (2_i64 << header.fraction_bits) as f64
            };
        }
        let step = DVec3::from_array(step);
        // In pixels from the picture's middle.
        let place = [(x as f64 + 1.0 - width) / 2.0, (height - 1.0 - y as f64) / 2.0];
        match model.camera.projection {
            Projection::Perspective { fov_y } => {
                // On a picture at distance 1.
                let pixel = 2.0 * (fov_y / 2.0).tan() / height;
                let meant = forward + (right * place[0] + up * place[1]) * pixel;
                // A unit on each axis, of a direction of at least 2^(bits - 1).
                let off = step.normalize().distance(meant.normalize());
                rule(off < 4.0 / (1_i64 << kernel.direction_bits) as f64, "directions")?;
            }
            Projection::Orthographic { height: extent } => {
                let meant = model.camera.position + (right * place[0] + up * place[1]) * (extent / height);
                let eye = DVec3::from_array(header.eye.map(|c| c as f64));
                let start = DVec3::from_array(header.origin) + (eye + step) / header.scale;
                let moved = (start - meant).dot(forward);
                // Half a unit on each axis, and what the coefficients are rounded by.
                let off = (start - meant - forward * moved).length() * header.scale;
                rule(off < 1.0, "origins")?;
                rule(moved * header.scale > -1.0, "a plane that is moved back")?;
                starts.push((start, moved));
            }
        }
    }
    if starts.is_empty() {
        return rule(header.along == [0; 3], "a direction of all rays");
    }
    let along = DVec3::from_array(header.along.map(|c| c as f64));
    rule(along.abs().max_element() < (1_i64 << kernel.direction_bits) as f64, "range of the direction")?;
    rule(along.normalize().distance(forward) < 4.0 / (1_i64 << kernel.direction_bits) as f64, "direction")?;
    let farthest = starts.iter().map(|&(start, _)| start.dot(forward)).fold(f64::NEG_INFINITY, f64::max);
    let is_moved = starts.iter().any(|(_, moved)| moved * header.scale > 1.0);
    let mut vertices = model.triangles.iter().flat_map(|t| t.vertices).map(|v| model.positions[v as usize]);
    rule(!is_moved || vertices.all(|v| v.dot(forward) > farthest), "a plane that is moved beyond what is seen")
}

fn tree(blob: &Blob) -> Checked {
    let (least, most) = blob.kernel.vertices;
    let (nodes, triangles) = (blob.nodes.len(), blob.triangles.len());
    let mut next = [0, 0, triangles];
    let levels = subtree(blob, blob.header.root, Bounds { low: [least; 3], high: [most; 3] }, &mut next)?;
    rule(next == [nodes, triangles, triangles + blob.spheres.len()], "nodes or primitives are left over")?;
    rule(levels == u32::from(blob.header.depth) && levels <= 64, "depth")
}

/// Checks a subtree against the next free node, triangle and sphere; its levels.
fn subtree(blob: &Blob, word: u32, holder: Bounds, next: &mut [usize; 3]) -> Result<u32, String> {
    let inside = |low: [i64; 3], high: [i64; 3]| {
        (0..3).all(|axis| holder.low[axis] <= low[axis] && high[axis] <= holder.high[axis])
    };
    if word >> 31 == 1 {
        let (count, first) = ((word >> 25 & 63) as usize + 1, (word & 0x1ff_ffff) as usize);
        if let Some(number) = first.checked_sub(blob.triangles.len()) {
            rule(first == next[2], "order of spheres")?;
            next[2] += count;
            let run = blob.spheres.get(number..number + count).ok_or("a leaf beyond the spheres")?;
            let boxes = run.iter().map(|s| (s.centre.map(|c| c - s.radius), s.centre.map(|c| c + s.radius)));
            rule(boxes.into_iter().all(|(low, high)| inside(low, high)), "a sphere outside its leaf's box")?;
            return Ok(0);
        }
        rule(first == next[1], "order of triangles")?;
        next[1] += count;
        let run = blob.triangles.get(first..first + count).ok_or("a leaf beyond the triangles")?;
        rule(run.iter().flat_map(|t| t.vertices).all(|v| inside(v, v)), "a vertex outside its leaf's box")?;
        return Ok(0);
    }
    rule(word as usize == next[0], "order of nodes")?;
    next[0] += 1;
    let node = *blob.nodes.get(word as usize).ok_or("a reference beyond the nodes")?;
    let mut levels = 0;
    for (bounds, child) in node.boxes.into_iter().zip(node.children) {
        rule(inside(bounds.low, bounds.high), "a box outside its parent's")?;
        levels = levels.max(1 + subtree(blob, child, bounds, next)?);
    }
    Ok(levels)
}

/// Whether samples are anywhere in their pixels.
fn is_sampled(header: &Header) -> bool {
    header.samples > 1 || header.needs >> 35 & 1 == 1
}

/// The root's boxes are tight, so what is within the span of the vertices is within that of the boxes.
fn origins(blob: &Blob) -> Checked {
    let header = &blob.header;
    let mut all: Vec<_> = blob.lights.iter().filter(|light| light.kind == 0).map(|light| light.place).collect();
    if header.along == [0; 3] {
        all.push(header.eye);
    } else {
        // Of the picture's corners, and half a pixel beyond them if need be.
        let f = header.fraction_bits;
        let (out, half, low) = if is_sampled(header) { (1, 1 << f >> 1, 2) } else { (0, 1 << f >> 1, 0) };
        let last = header.size.map(|side| 2 * (side as i64 - 1) + out);
        for (x, y) in [(-out, -out), (last[0], -out), (-out, last[1]), (last[0], last[1])] {
            let sum = |axis: usize| 2 * header.first[axis] + x * header.right[axis] + y * header.down[axis];
            all.push([0, 1, 2].map(|axis| header.eye[axis] + ((((sum(axis) + 1) >> 1) + half) >> f)));
            all.push([0, 1, 2].map(|axis| header.eye[axis] + (((sum(axis) >> 1) - low + half) >> f)));
        }
    }
    for origin in all {
        let vertices = blob.triangles.iter().flat_map(|t| t.vertices);
        let ends = blob.spheres.iter().flat_map(|s| [-s.radius, s.radius].map(|r| s.centre.map(|c| c + r)));
        let mut differences = vertices.chain(ends).flat_map(|point| minus(point, origin));
        rule(differences.all(|difference| difference.abs() <= blob.kernel.span), "span")?;
    }
    Ok(())
}

fn triangles(blob: &Blob, model: &Model) -> Checked {
    let kernel = blob.kernel;
    for (triangle, &id) in blob.triangles.iter().zip(&blob.ids) {
        let source = model.triangles.get(id as usize).ok_or("an id beyond the file")?;
        rule(triangle.vertices == source.vertices.map(|v| place(blob, model.positions[v as usize])), "vertices")?;
        rule(within(triangle.vertices.as_flattened(), kernel.vertices), "range of vertices")?;
        let [e1, e2] = triangle.edges;
        let magnitudes = [e1, e2, minus(e2, e1)].into_iter().flatten().map(i64::unsigned_abs);
        let b = (0..63).find(|&b| magnitudes.clone().all(|m| m < 1 << b)).unwrap_or(63);
        rule(triangle.shift == b, "shift")?;
        let normal = cross(e1, e2);
        rule(normal != [0; 3], "a triangle without area")?;
        let k = (2 * b).saturating_sub(kernel.normal_bits);
        rule(triangle.n == normal.map(|c| c >> k), "n")?;
        rule(triangle.material <= kernel.material_most, "range of materials")?;
        material(blob, triangle.material, &model.materials[source.material as usize])?;
    }
    let present: HashSet<u32> = blob.ids.iter().copied().collect();
    rule(present.len() == blob.ids.len(), "ids are not distinct")?;
    rule(blob.ids.len() == blob.triangles.len() + blob.spheres.len(), "an id for each")?;
    for (id, triangle) in (0..).zip(&model.triangles) {
        let [a, b, c] = triangle.vertices.map(|v| place(blob, model.positions[v as usize]));
        let has_area = cross(minus(b, a), minus(c, a)) != [0; 3];
        rule(present.contains(&id) == has_area, "triangles with area are there, and no others")?;
    }
    Ok(())
}

fn material(blob: &Blob, number: u32, meant: &Material) -> Checked {
    let material = blob.materials.get(number as usize).ok_or("a material that is not there")?;
    rule(is_light(&material.emission, meant.emission), "emission")
}

fn spheres(blob: &Blob, model: &Model) -> Checked {
    let kernel = blob.kernel;
    let of_file = |sphere: &model::Sphere| {
        let radius = (sphere.radius * blob.header.scale + 0.5).floor() as i64;
        (place(blob, sphere.centre), radius)
    };
    let ids = &blob.ids[blob.triangles.len()..];
    for (sphere, &id) in blob.spheres.iter().zip(ids) {
        let number = (id as usize).checked_sub(model.triangles.len()).ok_or("a sphere with a triangle's id")?;
        let source = model.spheres.get(number).ok_or("an id beyond the file")?;
        rule((sphere.centre, sphere.radius) == of_file(source), "centre and radius")?;
        let ends = [-sphere.radius, sphere.radius].map(|r| sphere.centre.map(|c| c + r));
        rule(within(ends.as_flattened(), kernel.vertices), "range of spheres")?;
        rule(sphere.material <= kernel.material_most, "range of materials")?;
        material(blob, sphere.material, &model.materials[source.material as usize])?;
    }
    for (number, sphere) in model.spheres.iter().enumerate() {
        let is_there = ids.contains(&((model.triangles.len() + number) as u32));
        rule(is_there == (of_file(sphere).1 >= kernel.radius_least), "spheres with room are there, and no others")?;
    }
    Ok(())
}

fn normals(blob: &Blob, model: &Model) -> Checked {
    let unit = (1_i64 << blob.kernel.unit_bits) as f64;
    let as_meant = |record: &[i64; 3], normal: DVec3| {
        // Rounded once or twice: to Q30, then to the kernel's format.
        record.iter().zip(normal.to_array()).all(|(&c, meant)| (c as f64 - meant * unit).abs() <= 0.5 + 2_f64.powi(-15))
    };
    for (corners, &id) in blob.corners.iter().zip(&blob.ids) {
        let (found, meant) = (corners, model.triangles[id as usize].normals);
        rule(found.is_some() == meant.is_some(), "which triangles are flat")?;
        for (index, normal) in found.iter().flatten().zip(meant.iter().flatten()) {
            let record = blob.normals.get(*index as usize).ok_or("a normal that is not there")?;
            rule(as_meant(record, model.normals[*normal as usize]), "normals")?;
        }
    }
    rule(blob.normals.iter().all(|n| is_unit(n, unit)), "length of normals")
}

fn is_unit(vector: &[i64; 3], unit: f64) -> bool {
    let square: f64 = vector.iter().map(|&c| (c as f64 / unit).powi(2)).sum();
    (square - 1.0).abs() < 2_f64.powi(-7)
}

fn shading(blob: &Blob, model: &Model) -> Checked {
    looks::agree(blob, model)?;
    rule(blob.lights.len() == model.lights.len(), "number of lights")?;
    for (light, meant) in blob.lights.iter().zip(&model.lights) {
        rule(is_light(&light.radiance, meant.radiance), "strength of a light")?;
        match meant.kind {
            LightKind::Point(position) => {
                rule(light.kind == 0 && light.place == place(blob, position), "place of a light")?;
            }
            LightKind::Directional(direction) => {
                let unit = 2_f64.powi(30);
                let towards = DVec3::from_array(light.place.map(|c| c as f64 / unit));
                let close = towards.distance(-direction.normalize()) < 2_f64.powi(-29);
                rule(light.kind == 1 && close && is_unit(&light.place, unit), "direction of a light")?;
            }
        }
    }
    Ok(())
}
