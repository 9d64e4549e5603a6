"""Register code as native code, by way of C and the compiler at hand."""
