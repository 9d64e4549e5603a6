local floor = math.floor

local function add_up(items, first, last, level, state)
   if level > state.deepest then
      state.deepest = level
   end
   if first == last then
      state.sum = state.sum + items[first]
   else
      local middle = floor((first + last) / 2)
      add_up(items, first, middle, level + 1, state)
      add_up(items, middle + 1, last, level + 1, state)
   end
end

local function work(n)
   local items, state = {}, { sum = 0, deepest = 0 }
   for i = 1, 256 do
      items[i] = i
   end
   for _ = 1, n do
      state.sum = 0
      add_up(items, 1, 256, 1, state)
   end
   return state.sum + state.deepest
end

return work
