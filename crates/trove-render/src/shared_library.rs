//! Libraries that are loaded at run time: their functions as fields.

/// Declares `Api`, the functions of a library under their symbols; the types have to be those of its header.
macro_rules! shared_library {
    ($($field:ident = $symbol:literal : fn($($arg:ty),*) $(-> $ret:ty)?;)*) => {
        /// The functions; they stay valid, because the library is never unloaded.
        pub(super) struct Api {
            $(pub(super) $field: unsafe extern "C" fn($($arg),*) $(-> $ret)?,)*
        }

        impl Api {
            fn from_library(library: Library) -> Result<Self, libloading::Error> {
                $(
                    // SAFETY: whoever declares the function vouches for its type, and the library stays loaded.
                    let $field = unsafe { *library.get::<unsafe extern "C" fn($($arg),*) $(-> $ret)?>($symbol)? };
                )*
                // oneTBB's threads may still be on their way out when the last device is released.
                std::mem::forget(library);
                Ok(Self { $($field,)* })
            }
        }
    };
}

pub(crate) use shared_library;
