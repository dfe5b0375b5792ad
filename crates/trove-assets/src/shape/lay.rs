//! Texture coordinates in metres for solids.

use glam::{Vec2, Vec3, vec2};

use super::Shape;

impl Shape {
    /// Texture coordinates anew, in metres: u runs along a direction, v around it as paper is wrapped around a parcel,
    /// with its seam below or behind; ends are laid flat. `from` is where on the texture the middle comes to lie.
    pub(crate) fn laid(mut self, along: Vec3, from: Vec2) -> Self {
        let up = if along.z.abs() > 0.9 { Vec3::X } else { Vec3::Z };
        let side = up.cross(along).normalize_or(Vec3::Y);
        let up = along.cross(side);
        let extent = self.positions.iter().map(|p| vec2(p.dot(side), p.dot(up)));
        let (low, high) = extent.fold((Vec2::MAX, Vec2::MIN), |(low, high), p| (low.min(p), high.max(p)));
        let (middle, half) = ((low + high) / 2.0, (high - low) / 2.0);
        for ((p, n), uv) in self.positions.iter().zip(&self.normals).zip(&mut self.uvs) {
            let q = vec2(p.dot(side), p.dot(up)) - middle;
            let facing = [n.dot(along).abs(), n.dot(side), n.dot(up)];
            let v = if facing[2].abs() >= facing[1].abs() {
                if facing[2] > 0.0 { q.x } else { 2.0 * (half.x + half.y) - q.x }
            } else if facing[1] > 0.0 {
                half.x + half.y - q.y
            } else {
                q.y - half.x - half.y
            };
            let is_end = facing[0] > facing[1].abs().max(facing[2].abs());
            *uv = from + if is_end { q } else { vec2(p.dot(along), v) };
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_laid_texture_has_its_size_and_meets_at_edges() {
        let block = Shape::rounded_block(Vec3::new(2.0, 0.4, 0.2), 0.001).laid(Vec3::X, Vec2::ZERO);
        let at = |p: Vec3, n: Vec3| {
            let near = |i: &usize| block.positions[*i].distance(p) < 0.01 && block.normals[*i].dot(n) > 0.99;
            block.uvs[(0..block.uvs.len()).find(near).unwrap()]
        };
        let corner = Vec3::new(1.0, 0.2, 0.1);
        let (top, side) = (at(corner, Vec3::Z), at(corner, Vec3::Y));
        assert!((top - vec2(1.0, 0.2)).length() < 0.01 && (side - top).length() < 0.01, "{top} {side}");
        let far = at(Vec3::new(-1.0, -0.2, 0.1), Vec3::Z);
        assert!((far - vec2(-1.0, -0.2)).length() < 0.01);
    }
}
