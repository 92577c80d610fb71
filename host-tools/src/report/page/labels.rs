//! Where names stand in a plot, so that none lies on another.
//!
//! Greedy: the point with the most neighbours first, each at the nearest free place about its point. In a plot of a dozen
//! names that is enough, and it is the same on every machine.

/// A rectangle, pixels; y runs downwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Rect {
    /// Left and right.
    pub(super) x: (i32, i32),
    /// Top and bottom.
    pub(super) y: (i32, i32),
}

impl Rect {
    /// About a point.
    pub(super) fn about((x, y): (i32, i32), half_width: i32, half_height: i32) -> Self {
        Self { x: (x - half_width, x + half_width), y: (y - half_height, y + half_height) }
    }

    /// Whether the insides have something in common.
    pub(super) fn meets(&self, other: &Self) -> bool {
        self.x.0 < other.x.1 && other.x.0 < self.x.1 && self.y.0 < other.y.1 && other.y.0 < self.y.1
    }

    fn contains(&self, other: &Self) -> bool {
        self.x.0 <= other.x.0 && other.x.1 <= self.x.1 && self.y.0 <= other.y.0 && other.y.1 <= self.y.1
    }

    /// The point of it that is nearest to another.
    pub(super) fn nearest(&self, (x, y): (i32, i32)) -> (i32, i32) {
        (x.clamp(self.x.0, self.x.1), y.clamp(self.y.0, self.y.1))
    }
}

/// Half the height of a name.
const HALF_HEIGHT: i32 = 8;
/// Half the side of a marker, with room about it.
const MARKER: i32 = 7;

/// A place for a name of each width beside each point, inside `area` and on no other name and no point; better not on
/// `lines` (points along what is drawn). `None` where the plot is full.
pub(super) fn place(points: &[((i32, i32), i32)], area: Rect, lines: &[(i32, i32)]) -> Vec<Option<Rect>> {
    let near = |a: (i32, i32), b: (i32, i32)| (a.0 - b.0).abs() < 80 && (a.1 - b.1).abs() < 40;
    let neighbours = |index: usize| points.iter().filter(|other| near(points[index].0, other.0)).count();
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by_key(|&index| std::cmp::Reverse(neighbours(index)));

    let markers: Vec<Rect> = points.iter().map(|&(point, _)| Rect::about(point, MARKER, MARKER)).collect();
    let mut places: Vec<Option<Rect>> = vec![None; points.len()];
    for index in order {
        let (point, width) = points[index];
        let free = |place: &Rect| {
            area.contains(place)
                && !markers.iter().any(|marker| marker.meets(place))
                && !places.iter().flatten().any(|other| other.meets(place))
        };
        let cost = |place: &Rect, distance: i32| {
            let crossed = lines.iter().filter(|&&at| Rect::about(at, 1, 1).meets(place)).count() as i32;
            let leader = |share: i32| {
                let to = place.nearest(point);
                (point.0 + (to.0 - point.0) * share / 8, point.1 + (to.1 - point.1) * share / 8)
            };
            // What a line to the name would cross, other than its own marker.
            let obstacles =
                || markers.iter().filter(|marker| **marker != markers[index]).chain(places.iter().flatten());
            let hits = (1..8).filter(|&share| obstacles().any(|one| Rect::about(leader(share), 1, 1).meets(one)));
            distance + 2 * crossed.min(10) + 25 * hits.count() as i32
        };
        let candidates = around(point, width).filter(|(place, _)| free(place));
        let best = candidates.map(|(place, distance)| (cost(&place, distance), place)).min_by_key(|best| best.0);
        places[index] = best.map(|best| best.1);
    }
    places
}

/// Rectangles of a width about a point, with their distances from it: sixteen directions, the right first.
fn around(point: (i32, i32), width: i32) -> impl Iterator<Item = (Rect, i32)> {
    (0..28).flat_map(move |ring| {
        let distance = MARKER + 1 + 7 * ring;
        (0..16).map(move |direction| {
            let angle = f64::from(direction) * std::f64::consts::TAU / 16.0;
            let (x, y) = (libm::cos(angle), -libm::sin(angle));
            let out = |share: f64, half: i32| libm::round(share * f64::from(distance + half)) as i32;
            let centre = (point.0 + out(x, width / 2), point.1 + out(y, HALF_HEIGHT));
            (Rect::about(centre, (width + 1) / 2, HALF_HEIGHT), distance)
        })
    })
}

/// Heights for names in a column, each as near to where it wants to be as its neighbours `gap` away allow; those that want
/// the same keep their order. All are within `from` and `to` if there is room.
pub(super) fn stack(wanted: &[i32], gap: i32, (from, to): (i32, i32)) -> Vec<i32> {
    let mut order: Vec<usize> = (0..wanted.len()).collect();
    order.sort_by_key(|&index| wanted[index]);
    let mut heights = vec![0; wanted.len()];
    let mut next = from;
    for &index in &order {
        heights[index] = wanted[index].max(next);
        next = heights[index] + gap;
    }
    // Back from the end, for those that were pushed out of it.
    let mut most = to;
    for &index in order.iter().rev() {
        heights[index] = heights[index].min(most);
        most = heights[index] - gap;
    }
    heights
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const AREA: Rect = Rect { x: (0, 440), y: (0, 300) };

    proptest! {
        #[test]
        fn no_name_lies_on_another_or_on_a_point(
            points in prop::collection::vec(((0..440i32, 0..300i32), 20..110i32), 0..14)
        ) {
            let places = place(&points, AREA, &[]);
            for (index, place) in places.iter().enumerate() {
                let place = place.expect("there is room for fourteen");
                prop_assert!(AREA.contains(&place));
                prop_assert!(points.iter().all(|&(point, _)| !place.meets(&Rect::about(point, 3, 3))));
                prop_assert!(places[..index].iter().flatten().all(|other| !other.meets(&place)));
            }
        }

        #[test]
        fn a_column_keeps_its_distances(wanted in prop::collection::vec(0..300i32, 0..20)) {
            let heights = stack(&wanted, 15, (0, 300));
            let mut sorted = heights.clone();
            sorted.sort_unstable();
            prop_assert!(sorted.windows(2).all(|pair| pair[1] - pair[0] >= 15));
            prop_assert!(heights.iter().all(|height| (0..=300).contains(height)));
        }
    }

    #[test]
    fn a_full_plot_leaves_names_out() {
        let tiny = Rect { x: (0, 60), y: (0, 30) };
        let points = vec![((30, 15), 50); 5];
        assert!(place(&points, tiny, &[]).contains(&None));
    }
}
