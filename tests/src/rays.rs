//! Rays that look for trouble: through vertices and edges, in planes, off surfaces, with tiny
//! directions.
//!
//! The kinds are exact where they say so: a ray through a vertex passes it with no rounding, so
//! that its hit is a tie between all the triangles that meet there. The same seed gives the same
//! rays on every machine.

use crate::oracle::{Ray, Triangle};
use crate::random::SplitMix64;

/// What a ray is aimed at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// From anywhere, in any direction or to a point on a triangle.
    Random,
    /// Exactly through a vertex.
    ThroughVertex,
    /// Exactly through a point of an edge, which need not be a grid point.
    AlongEdge,
    /// Along an axis, in an axis-parallel plane that holds a point of an edge, or through that
    /// point.
    AxisParallel,
    /// Along an edge or another combination of edges, through a vertex: no triangle of that plane
    /// is hit. Only approximately in the plane where the shortest such direction exceeds the bound.
    InPlane,
    /// Components of at most two units.
    TinyDirection,
    /// From the grid point next to a point on a triangle; half of them skip that triangle.
    FromSurface,
    /// From the corners, face centres and centre of the grid, to vertices.
    Corner,
    /// A segment from one surface to another, as a shadow ray is; half of them skip the first
    /// triangle.
    Segment,
    /// In a triangle's plane and through a vertex, each but for a unit.
    Grazing,
}

impl Kind {
    /// Every kind, in the order in which [`Rays`] takes turns.
    pub const ALL: [Self; 10] = [
        Self::Random,
        Self::ThroughVertex,
        Self::AlongEdge,
        Self::AxisParallel,
        Self::InPlane,
        Self::TinyDirection,
        Self::FromSurface,
        Self::Corner,
        Self::Segment,
        Self::Grazing,
    ];
}

/// What a kernel admits, in grid units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bounds {
    /// Vertices lie in 0..2^grid_bits.
    pub grid_bits: u32,
    /// Least and greatest coordinate of an origin; they enclose the grid.
    pub origin: [i64; 2],
    /// Greatest absolute value of a component of a direction, at least 2.
    pub direction: i64,
}

/// An endless sequence of rays for one mesh, the kinds taking turns.
#[derive(Clone, Debug)]
pub struct Rays<'a> {
    triangles: &'a [Triangle],
    bounds: Bounds,
    random: SplitMix64,
    turn: usize,
}

impl<'a> Rays<'a> {
    /// Rays for a mesh whose vertices lie on the grid.
    ///
    /// # Panics
    /// If there is no triangle, or the bounds contradict each other.
    pub fn new(triangles: &'a [Triangle], bounds: Bounds, seed: u64) -> Self {
        let [low, high] = bounds.origin;
        assert!(!triangles.is_empty(), "rays need a triangle to aim at");
        assert!(low <= 0 && high >= (1 << bounds.grid_bits) - 1 && bounds.direction >= 2, "{bounds:?}");
        Self { triangles, bounds, random: SplitMix64(seed), turn: 0 }
    }

    /// The next ray of one kind. Its direction is not zero.
    pub fn ray(&mut self, kind: Kind) -> Ray {
        let mut ray = Ray { origin: self.origin(), direction: [0; 3], limit: None, skip: None };
        match kind {
            Kind::Random => {
                (ray.origin, ray.direction) = if self.random.coin() {
                    (ray.origin, self.direction(self.bounds.direction))
                } else {
                    let target = self.surface().1;
                    self.through(ray.origin, target)
                }
            }
            Kind::ThroughVertex => {
                let target = self.edge()[0];
                (ray.origin, ray.direction) = self.through(ray.origin, target);
            }
            Kind::AlongEdge => (ray.origin, ray.direction) = self.across_edge(ray.origin),
            Kind::AxisParallel => {
                let point = self.edge_point();
                let axis = self.random.below(3) as usize;
                let free = self.random.below(3) as usize; // the axis itself: through the point
                ray.origin = [0, 1, 2].map(|i| if i == axis || i == free { ray.origin[i] } else { point[i] });
                let speed = self.random.below(self.bounds.direction as u64) as i64 + 1;
                ray.direction[axis] = if ray.origin[axis] < point[axis] { speed } else { -speed };
            }
            Kind::InPlane => {
                let (vertex, direction) = self.in_plane();
                ray.direction = direction;
                ray.origin = self.before(vertex, direction);
            }
            Kind::TinyDirection => {
                ray.direction = self.direction(2);
                if self.random.coin() {
                    let point = self.surface().1;
                    ray.origin = self.before(point, ray.direction);
                }
            }
            Kind::FromSurface => {
                let (prim, origin) = self.surface();
                ray.origin = origin;
                ray.direction = self.direction(self.bounds.direction);
                ray.skip = self.random.coin().then_some(prim);
            }
            Kind::Corner => {
                let last = (1 << self.bounds.grid_bits) - 1;
                let corner = [0, 1, 2].map(|_| [0, (last + 1) / 2, last][self.random.below(3) as usize]);
                let target = self.edge()[0];
                (ray.origin, ray.direction) = self.through(corner, target);
            }
            Kind::Segment => {
                let (prim, origin) = self.surface();
                let target = if self.random.coin() { self.surface().1 } else { self.edge()[0] };
                ray.origin = origin;
                ray.direction = self.fit(difference(target, origin));
                ray.limit = Some(0);
                ray.skip = self.random.coin().then_some(prim);
            }
            Kind::Grazing => {
                let (vertex, direction) = self.in_plane();
                ray.direction = self.nudge(direction, [-self.bounds.direction, self.bounds.direction]);
                let point = self.nudge(vertex, self.bounds.origin);
                ray.origin = self.before(point, ray.direction);
            }
        }
        if ray.direction == [0; 3] {
            ray.direction = self.direction(2); // origin and target coincided
        }
        ray
    }

    /// A direction with components of at most `size`, and not zero.
    fn direction(&mut self, size: i64) -> [i64; 3] {
        loop {
            let direction = [0; 3].map(|_| self.random.within([-size, size]));
            if direction != [0; 3] {
                return direction;
            }
        }
    }

    fn origin(&mut self) -> [i64; 3] {
        [0; 3].map(|_| self.random.within(self.bounds.origin))
    }

    fn triangle(&mut self) -> (u32, Triangle) {
        let prim = self.random.below(self.triangles.len() as u64);
        (prim as u32, self.triangles[prim as usize])
    }

    /// The two ends of an edge, either first.
    fn edge(&mut self) -> [[i64; 3]; 2] {
        let (_, triangle) = self.triangle();
        let first = self.random.below(3) as usize;
        let step = 1 + self.random.below(2) as usize;
        [triangle[first], triangle[(first + step) % 3]]
    }

    /// A grid point that lies on an edge exactly; an end of it if there is no other.
    fn edge_point(&mut self) -> [i64; 3] {
        let [a, b] = self.edge();
        let edge = difference(b, a);
        let parts = common_divisor(edge).max(1);
        let part = self.random.within([0, parts]);
        [0, 1, 2].map(|i| a[i] + edge[i] / parts * part)
    }

    /// A triangle and the grid point nearest to some point on it.
    fn surface(&mut self) -> (u32, [i64; 3]) {
        const ONE: i64 = 1 << 16;
        let (prim, [v0, v1, v2]) = self.triangle();
        let (mut a, mut b) = (self.random.within([0, ONE]), self.random.within([0, ONE]));
        if a + b > ONE {
            (a, b) = (ONE - a, ONE - b);
        }
        let point = [0, 1, 2].map(|i| ((ONE - a - b) * v0[i] + a * v1[i] + b * v2[i] + ONE / 2) >> 16);
        (prim, point)
    }

    /// A vertex of a triangle and a direction in its plane: along an edge or a small combination of
    /// two.
    fn in_plane(&mut self) -> ([i64; 3], [i64; 3]) {
        let (_, mut triangle) = self.triangle();
        triangle.rotate_left(self.random.below(3) as usize);
        let [v0, v1, v2] = triangle;
        let (e1, e2) = (difference(v1, v0), difference(v2, v0));
        let (m, n) = (self.random.within([1, 2]), self.random.within([-2, 2]));
        let combined = [0, 1, 2].map(|i| m * e1[i] + n * e2[i]);
        (v0, self.fit(if self.fits(combined) { combined } else { e1 }))
    }

    /// Each coordinate moved by one, or not, within the bounds.
    fn nudge(&mut self, v: [i64; 3], [low, high]: [i64; 2]) -> [i64; 3] {
        v.map(|c| (c + self.random.within([-1, 1])).clamp(low, high))
    }

    fn fits(&self, d: [i64; 3]) -> bool {
        d.iter().all(|c| c.abs() <= self.bounds.direction)
    }

    /// The direction within the bound: as it is, else reduced to lowest terms, else halved,
    /// rounding to zero.
    fn fit(&self, d: [i64; 3]) -> [i64; 3] {
        if self.fits(d) {
            return d;
        }
        let mut d = d.map(|c| c / common_divisor(d).max(1));
        while !self.fits(d) {
            d = d.map(|c| c / 2);
        }
        d
    }

    /// A ray through a grid point exactly, starting at `origin` if the direction bound permits
    /// that.
    fn through(&mut self, origin: [i64; 3], point: [i64; 3]) -> ([i64; 3], [i64; 3]) {
        let direct = difference(point, origin);
        let direction = self.fit(direct);
        // Each component was divided by nearly the same number; the smallest quotient is how often
        // the direction fits between the two, so the new origin lies between them, within the
        // bounds.
        let times = (0..3).filter(|&i| direction[i] != 0).map(|i| direct[i] / direction[i]).min().unwrap_or(0);
        ([0, 1, 2].map(|i| point[i] - times * direction[i]), direction)
    }

    /// A ray through (w a + (n - w) b) / n on an edge a b: that point is o + d / n for d = w a + (n
    /// - w) b - n o. Through a grid point of an edge where the direction bound forbids that.
    fn across_edge(&mut self, origin: [i64; 3]) -> ([i64; 3], [i64; 3]) {
        let [a, b] = self.edge();
        let n = self.random.within([2, 4]);
        let w = self.random.within([1, n - 1]);
        let direction = [0, 1, 2].map(|i| w * a[i] + (n - w) * b[i] - n * origin[i]);
        if self.fits(direction) && self.random.coin() {
            return (origin, direction);
        }
        let point = self.edge_point();
        self.through(origin, point)
    }

    /// An origin from which the direction leads to the point in a whole number of steps; the point
    /// itself where the bounds leave no room for a step.
    fn before(&mut self, point: [i64; 3], d: [i64; 3]) -> [i64; 3] {
        let [low, high] = self.bounds.origin;
        let room = |i: usize| {
            if d[i] > 0 { point[i] - low } else { high - point[i] }
        };
        let most = (0..3).filter(|&i| d[i] != 0).map(|i| room(i) / d[i].abs()).min().unwrap_or(0);
        let steps = self.random.within([most.min(1), most]);
        [0, 1, 2].map(|i| point[i] - steps * d[i])
    }
}

impl Iterator for Rays<'_> {
    type Item = (Kind, Ray);

    fn next(&mut self) -> Option<(Kind, Ray)> {
        let kind = Kind::ALL[self.turn % Kind::ALL.len()];
        self.turn += 1;
        Some((kind, self.ray(kind)))
    }
}

fn difference(a: [i64; 3], b: [i64; 3]) -> [i64; 3] {
    [0, 1, 2].map(|i| a[i] - b[i])
}

/// The greatest common divisor of the components; 0 for the zero vector.
fn common_divisor(v: [i64; 3]) -> i64 {
    v.into_iter().fold(0, |mut a, mut b| {
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a.abs()
    })
}

#[cfg(test)]
mod tests;
