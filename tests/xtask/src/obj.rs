//! What the scene generators share: parts of a mesh, and their text as OBJ.

use glam::DVec3;
use std::fmt::Write as _;

/// A group of the OBJ: one material, faces of three or more corners, counter-clockwise from their front.
pub(crate) struct Part {
    pub(crate) name: &'static str,
    pub(crate) material: &'static str,
    pub(crate) positions: Vec<DVec3>,
    /// One for each position, or none for a flat part.
    pub(crate) normals: Vec<DVec3>,
    pub(crate) faces: Vec<Vec<usize>>,
}

/// The OBJ text of `parts` after `head`, six decimals a figure. Indices count from the file's start, as OBJ has it.
pub(crate) fn text(head: &str, parts: &[Part]) -> String {
    let mut text = String::from(head);
    let (mut positions, mut normals) = (1, 1);
    // Writing to a String cannot fail.
    let vector = |text: &mut String, keyword: &str, v: DVec3| {
        // Rounded first, and 0 added, for a tiny negative number would print as -0.000000.
        let [x, y, z] = v.to_array().map(|c| (c * 1e6).round() / 1e6 + 0.0);
        let _ = writeln!(text, "{keyword} {x:.6} {y:.6} {z:.6}");
    };
    for part in parts {
        let _ = writeln!(text, "g {}\nusemtl {}", part.name, part.material);
        part.positions.iter().for_each(|&position| vector(&mut text, "v", position));
        part.normals.iter().for_each(|&normal| vector(&mut text, "vn", normal));
        for face in &part.faces {
            text.push('f');
            for corner in face {
                let _ = match part.normals.is_empty() {
                    true => write!(text, " {}", positions + corner),
                    false => write!(text, " {}//{}", positions + corner, normals + corner),
                };
            }
            text.push('\n');
        }
        positions += part.positions.len();
        normals += part.normals.len();
    }
    text
}

#[cfg(test)]
impl Part {
    /// Its faces as fans.
    pub(crate) fn triangles(&self) -> impl Iterator<Item = [usize; 3]> {
        self.faces.iter().flat_map(|face| face[1..].windows(2).map(|pair| [face[0], pair[0], pair[1]]))
    }

    /// Whether each edge is there once in each direction: closed, and wound the same way throughout.
    pub(crate) fn is_closed(&self) -> bool {
        let edges: Vec<_> = self.triangles().flat_map(|[a, b, c]| [(a, b), (b, c), (c, a)]).collect();
        let count = |edge| edges.iter().filter(|&&other| other == edge).count();
        edges.iter().all(|&(a, b)| count((a, b)) == 1 && count((b, a)) == 1)
    }

    /// Positive where the faces of a closed part face outwards.
    pub(crate) fn volume(&self) -> f64 {
        self.triangles().map(|face| face.map(|i| self.positions[i])).map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
    }
}
