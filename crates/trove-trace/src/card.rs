//! What a card runs: one thread a ray, or a path.

use core::arch::nvptx::{_block_dim_x, _block_idx_x, _thread_idx_x, trap};

use crate::flat::{Asked, FlatScene};
use crate::ray::Hit;
use crate::wave::{Step, Wave};
use crate::world::FlatWorld;

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    // SAFETY: it ends the kernel, which the driver tells.
    unsafe { trap() }
}

/// This thread's ray or path.
#[inline(always)]
fn place() -> usize {
    // SAFETY: these read registers.
    unsafe { (_block_idx_x() * _block_dim_x() + _thread_idx_x()) as usize }
}

/// The nearest surface of each ray; where there is none, it is [`Hit::NOTHING`].
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
        *hits.add(i) = (*scene).closest(&*asked.add(i)).unwrap_or(Hit::NOTHING);
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

/// A step of a wave for each of `count` paths.
macro_rules! steps {
    ($($name:ident: $step:ident),*) => {
        $(
            /// # Safety
            /// As for [`Wave::step`], and it is that step's turn.
            #[unsafe(no_mangle)]
            unsafe extern "ptx-kernel" fn $name(world: *const FlatWorld, wave: *const Wave, which: u32, count: u32) {
                let i = place();
                if i < count as usize {
                    // SAFETY: the caller vouches for it.
                    unsafe { (*wave).step(Step::$step, &*world, which as usize, i) };
                }
            }
        )*
    };
}

steps!(begin: Begin, trace: Trace, shelter: Shelter, arrive: Arrive, scatter: Scatter, ask: Ask, send: Send, light: Light, end: End);
