//! obvhs's binary hierarchies as the flat pairs of boxes that rays are traced through.

use std::time::Duration;

use glam::Vec3;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::{build_bvh2, build_bvh2_from_tris};
use obvhs::triangle::Triangle;
use trove_trace::{DEPTH, Pair, inner, leaf};

/// Pairs from a root down, and what lies in the leaves, in their order.
pub(super) struct Hierarchy {
    pub(super) pairs: Vec<Pair>,
    pub(super) root: u32,
    /// Indices of the boxes or triangles that it was built over.
    pub(super) order: Vec<u32>,
}

/// What lies below a pair's child.
struct Below {
    bounds: [Vec3; 2],
    child: u32,
    /// Pairs from there down to the deepest leaf.
    depth: usize,
}

impl Hierarchy {
    /// Over boxes, one in each leaf; at least one.
    pub(super) fn over_boxes(boxes: &[Aabb]) -> Self {
        let params = BvhBuildParams { max_prims_per_leaf: 1, ..BvhBuildParams::medium_build() };
        Self::flat(&build_bvh2(boxes, params, &mut Duration::default()), DEPTH, |i| boxes[i as usize])
    }

    /// Over triangles; at least one.
    pub(super) fn over_triangles(triangles: &[[Vec3; 3]]) -> Self {
        let boxed = |&[a, b, c]: &[Vec3; 3]| Triangle { v0: a.into(), v1: b.into(), v2: c.into() };
        let boxed: Vec<_> = triangles.iter().map(boxed).collect();
        let bvh = build_bvh2_from_tris(&boxed, BvhBuildParams::medium_build(), &mut Duration::default());
        Self::flat(&bvh, DEPTH, |i| {
            let [a, b, c] = triangles[i as usize];
            Aabb { min: a.min(b).min(c).into(), max: a.max(b).max(c).into() }
        })
    }

    fn flat(bvh: &Bvh2, deepest: usize, bounds_of: impl Fn(u32) -> Aabb) -> Self {
        let mut pairs = Vec::with_capacity(bvh.nodes.len() / 2);
        let order = bvh.primitive_indices.clone();
        let below = if is_deeper_than(bvh, deepest) {
            // Where shapes defy the builder, halves of its order are good enough.
            halves(&order, 0, &bounds_of, &mut pairs)
        } else {
            of_node(bvh, 0, &mut pairs)
        };
        debug_assert!(below.depth <= DEPTH);
        Self { pairs, root: below.child, order }
    }
}

fn is_deeper_than(bvh: &Bvh2, most: usize) -> bool {
    let mut deepest = 0;
    let mut left = vec![(0, 0)];
    while let Some((node, depth)) = left.pop()
        && deepest <= most
    {
        let node = &bvh.nodes[node as usize];
        if !node.is_leaf() {
            deepest = deepest.max(depth + 1);
            left.extend([(node.first_index, depth + 1), (node.first_index + 1, depth + 1)]);
        }
    }
    deepest > most
}

/// A node and all below it, pairs in the order in which rays go down.
fn of_node(bvh: &Bvh2, index: u32, pairs: &mut Vec<Pair>) -> Below {
    let node = &bvh.nodes[index as usize];
    let bounds = [node.aabb().min.into(), node.aabb().max.into()];
    if node.is_leaf() {
        return Below { bounds, child: leaf(node.first_index, node.prim_count), depth: 0 };
    }
    joined(pairs, |pairs| [0, 1].map(|i| of_node(bvh, node.first_index + i, pairs)))
}

/// Places of `order`, the first of which is `first`, cut in halves over and over.
fn halves(order: &[u32], first: u32, bounds_of: &impl Fn(u32) -> Aabb, pairs: &mut Vec<Pair>) -> Below {
    if let &[one] = order {
        let Aabb { min, max } = bounds_of(one);
        return Below { bounds: [min.into(), max.into()], child: leaf(first, 1), depth: 0 };
    }
    let (low, high) = order.split_at(order.len() / 2);
    let middle = first + low.len() as u32;
    joined(pairs, |pairs| [halves(low, first, bounds_of, pairs), halves(high, middle, bounds_of, pairs)])
}

/// A pair that comes before what is below it.
fn joined(pairs: &mut Vec<Pair>, children: impl FnOnce(&mut Vec<Pair>) -> [Below; 2]) -> Below {
    let at = pairs.len();
    pairs.push(Pair::default());
    let [a, b] = children(pairs);
    pairs[at] = Pair::new([a.bounds, b.bounds], [a.child, b.child]);
    let bounds = [a.bounds[0].min(b.bounds[0]), a.bounds[1].max(b.bounds[1])];
    Below { bounds, child: inner(at as u32), depth: 1 + a.depth.max(b.depth) }
}

#[cfg(test)]
mod tests {
    use glam::Affine3A;
    use trove_model::Seed;
    use trove_trace::{Corners, Mesh, Ray, Tables};

    use super::*;

    struct Shards(Hierarchy, Vec<Corners>);

    impl Tables for Shards {
        fn top(&self) -> (&[Pair], u32) {
            (&[], leaf(0, 1))
        }

        fn instance(&self, place: u32) -> u32 {
            place
        }

        fn mesh(&self, _: u32) -> Mesh<'_> {
            Mesh { pairs: &self.0.pairs, corners: &self.1, root: self.0.root }
        }

        fn mesh_from_world(&self, _: u32, _: f32) -> Affine3A {
            Affine3A::IDENTITY
        }
    }

    #[test]
    fn a_hierarchy_that_is_too_deep_is_cut_in_halves_and_finds_the_same() {
        let mut random = Seed(4).random();
        let mut vector = |size: f64| Vec3::from_array(std::array::from_fn(|_| random.range(-size, size) as f32));
        let triangles: Vec<[Vec3; 3]> = (0..999)
            .map(|_| {
                let middle = vector(1.0);
                [(); 3].map(|()| middle + vector(0.1))
            })
            .collect();
        let boxes: Vec<Aabb> = triangles
            .iter()
            .map(|t| Aabb { min: t[0].min(t[1]).min(t[2]).into(), max: t[0].max(t[1]).max(t[2]).into() })
            .collect();
        let params = BvhBuildParams { max_prims_per_leaf: 1, ..BvhBuildParams::medium_build() };
        let bvh = build_bvh2(&boxes, params, &mut Duration::default());
        let shards = |deepest: usize| {
            let flat = Hierarchy::flat(&bvh, deepest, |i| boxes[i as usize]);
            let corners = flat.order.iter().map(|&i| Corners::new(triangles[i as usize], i)).collect();
            Shards(flat, corners)
        };
        let [whole, halves] = [shards(DEPTH), shards(10)];
        assert!(is_deeper_than(&bvh, 10) && !is_deeper_than(&bvh, DEPTH));
        let mut hits = 0;
        for _ in 0..2000 {
            let (origin, direction) = (vector(3.0), vector(1.0));
            let ray = Ray { origin, t_min: 0.0, direction, t_max: f32::INFINITY, time: 0.5 };
            let [a, b] = [&whole, &halves].map(|shards| trove_trace::closest(shards, &ray, |_| true, |_| true));
            assert_eq!(a, b, "{ray:?}");
            hits += usize::from(a.is_some());
        }
        assert!(hits > 50, "{hits}");
    }
}
