//! The bytes of a linked program.

use std::fs;

use object::{Object, ObjectSection, SectionFlags, SectionKind};

use crate::boards::Board;
use crate::folder;

/// Bytes of a program in flash, and in RAM without its stack.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sizes {
    pub(crate) flash: u64,
    pub(crate) ram: u64,
}

impl Sizes {
    /// Of the program as it was built for release.
    pub(crate) fn of(board: &Board) -> Self {
        let path = folder().join("target").join(board.target).join("release").join(board.folder);
        let Ok(data) = fs::read(&path) else {
            panic!("{} is not built: run ./build", path.display());
        };
        let elf = object::File::parse(&*data).expect("it is an ELF file");
        let mut sizes = Self { flash: 0, ram: 0 };
        for section in elf.sections() {
            let SectionFlags::Elf { sh_flags } = section.flags() else { continue };
            // What is not loaded, and what esp-hal leaves to the stack.
            if sh_flags & u64::from(object::elf::SHF_ALLOC) == 0 || section.name() == Ok(".stack") {
                continue;
            }
            if section.kind() != SectionKind::UninitializedData {
                sizes.flash += section.size();
            }
            // Code may be copied to RAM, too.
            if board.ram.iter().any(|range| range.contains(&section.address())) {
                sizes.ram += section.size();
            }
        }
        sizes
    }
}
