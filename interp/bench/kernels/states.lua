local RED, AMBER, GREEN = 1, 2, 3

local function work(n)
   local lanes, now, passed, k = {}, RED, 0, 1
   for lane = 1, 4 do
      lanes[lane] = { last = RED, times = 0, busy = false }
   end
   for _ = 1, n do
      if now == RED then
         now = GREEN
      elseif now == GREEN then
         now = AMBER
         passed = passed + 1
      else
         now = RED
      end
      local lane = lanes[k]
      lane.busy = now == GREEN and lane.last ~= GREEN
      lane.last = now
      if lane.busy or now == RED then
         lane.times = lane.times + 1
      end
      k = k + 1
      if k > 4 then
         k = 1
      end
   end
   return passed + lanes[1].times + lanes[4].times
end

return work
