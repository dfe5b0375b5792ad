//! What a card runs: one thread a ray, or a vertex.

use core::arch::nvptx::{_block_dim_x, _block_idx_x, _thread_idx_x, trap};

use crate::flat::{Asked, FlatScene, NONE};
use crate::ray::Hit;
use crate::vertex::{FlatMaterials, Scattered, Vertex};

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    // SAFETY: it ends the kernel, which the driver tells.
    unsafe { trap() }
}

/// This thread's ray or vertex.
#[inline(always)]
fn place() -> usize {
    // SAFETY: these read registers.
    unsafe { (_block_idx_x() * _block_dim_x() + _thread_idx_x()) as usize }
}

/// The nearest surface of each ray; where there is none, the instance is [`NONE`].
///
/// # Safety
/// There are `count` rays and room for as many hits, and the scene is as `FlatScene::closest` wants it.
#[unsafe(no_mangle)]
unsafe extern "ptx-kernel" fn closest(scene: *const FlatScene, asked: *const Asked, hits: *mut Hit, count: u32) {
    let i = place();
    if i >= count as usize {
        return;
    }
    // SAFETY: the caller vouches for it.
    unsafe {
        let nothing = Hit { t: f32::INFINITY, instance: NONE, triangle: NONE, u: 0.0, v: 0.0 };
        *hits.add(i) = (*scene).closest(&*asked.add(i)).unwrap_or(nothing);
    }
}

/// 1 for each ray that meets a surface, else 0.
///
/// # Safety
/// As for [`closest`].
#[unsafe(no_mangle)]
unsafe extern "ptx-kernel" fn blocked(scene: *const FlatScene, asked: *const Asked, blocked: *mut u32, count: u32) {
    let i = place();
    if i >= count as usize {
        return;
    }
    // SAFETY: the caller vouches for it.
    unsafe {
        *blocked.add(i) = u32::from((*scene).is_blocked(&*asked.add(i)));
    }
}

/// How light scatters at each vertex.
///
/// # Safety
/// There are `count` vertices and room for as many answers, and materials are as `FlatMaterials::scatter` wants them.
#[unsafe(no_mangle)]
unsafe extern "ptx-kernel" fn scatter(
    materials: *const FlatMaterials,
    vertices: *const Vertex,
    scattered: *mut Scattered,
    count: u32,
) {
    let i = place();
    if i >= count as usize {
        return;
    }
    // SAFETY: the caller vouches for it.
    unsafe {
        *scattered.add(i) = (*materials).scatter(&*vertices.add(i));
    }
}
