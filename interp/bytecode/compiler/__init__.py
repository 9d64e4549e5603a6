"""The compiler: translates checked programs to bytecode.

A `project` compiles routines as they are called, each into one code object. The parts that generate
its code form layers: `statements`; `control_flow` and `motions`; `calls` with `predefined_calls`;
`expressions`; `designators`; `loads_and_stores`; `emitter`. Each part is given the layers
below it. Where code has to call upwards, the part is given a function: expressions call routines,
designators contain expressions as indices, blocks contain statements.
"""
