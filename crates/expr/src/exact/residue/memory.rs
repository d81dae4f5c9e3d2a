//! Memory for long tables, in large pages where the system has them on request.
//!
//! The first access to a page costs as much as a thousand products, and the columns of a long table
//! lie in a page each: in large pages both cost next to nothing. Without large pages, and for short
//! tables, ordinary memory is used.

use super::Lanes;

/// Memory for a number of lanes, zero at first.
pub struct Memory {
    pages: Pages,
}

enum Pages {
    Usual(Vec<Lanes>),
    #[cfg(target_os = "linux")]
    Large(large::HugePages),
}

impl Memory {
    /// Allocates memory for `count` lanes of zeros.
    pub fn zeroed(count: usize) -> Self {
        #[cfg(target_os = "linux")]
        if let Some(large) = large::HugePages::zeroed(count) {
            return Self { pages: Pages::Large(large) };
        }
        Self { pages: Pages::Usual(vec![Lanes::default(); count]) }
    }

    /// All lanes.
    pub fn lanes(&mut self) -> &mut [Lanes] {
        match &mut self.pages {
            Pages::Usual(lanes) => lanes,
            #[cfg(target_os = "linux")]
            Pages::Large(large) => large.lanes(),
        }
    }
}

#[cfg(target_os = "linux")]
mod large {
    use std::ops::Range;

    use memmap2::{Advice, MmapMut};

    use super::Lanes;

    /// A large page, in bytes.
    const PAGE: usize = 2 << 20;
    /// Number of bytes below which the zeros of a whole large page cost more than it spares.
    const LEAST: usize = PAGE / 2;

    /// A mapping, and the range of its bytes that is used, which begins with a large page.
    pub struct HugePages {
        mapping: MmapMut,
        used: Range<usize>,
    }

    impl HugePages {
        /// Allocates memory for `count` lanes of zeros; `None` if it is too little for a large
        /// page, or the mapping fails.
        pub fn zeroed(count: usize) -> Option<Self> {
            let bytes = count.checked_mul(size_of::<Lanes>())?;
            if bytes < LEAST {
                return None;
            }
            let mapping =
                MmapMut::map_anon(bytes.checked_next_multiple_of(PAGE)?.checked_add(PAGE)?).ok()?;
            // If the system has no large pages, the mapping is ordinary memory.
            let _ = mapping.advise(Advice::HugePage);
            let start = mapping.as_ptr().align_offset(PAGE);
            let used = start..start.checked_add(bytes)?;
            (used.end <= mapping.len()).then_some(Self { mapping, used })
        }

        pub fn lanes(&mut self) -> &mut [Lanes] {
            bytemuck::cast_slice_mut(&mut self.mapping[self.used.clone()])
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_as_long_as_asked_for_and_zero() {
        for count in [0, 1, 1000, 4096, 40_000, 100_000] {
            let mut memory = Memory::zeroed(count);
            assert_eq!(memory.lanes().len(), count);
            assert!(memory.lanes().iter().all(|lanes| *lanes == Lanes::default()));
            memory.lanes().fill(Lanes::all(7));
            assert!(memory.lanes().iter().all(|lanes| *lanes == Lanes::all(7)));
        }
    }
}
