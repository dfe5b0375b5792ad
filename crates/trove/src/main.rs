//! The command line as a plain program, for those who build without Python.

fn main() {
    std::process::exit(trove::main(std::env::args_os(), &[]));
}
